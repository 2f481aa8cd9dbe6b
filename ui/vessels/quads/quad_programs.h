// The shaders that draw segments as quads.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/result.h"
#include "ui/gl/program.h"
#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// Chosen per cluster, by the largest radius that it may contain.
enum class QuadKind : std::uint8_t {
  thin,  // two triangles; the depth is not flat at the round ends, which no pixel shows
  round, // six triangles, with the depth of the axis
  near,  // two triangles; writes the surface's own depth, which prevents the early depth test
};
inline constexpr int quad_kind_count = 3;

constexpr QuadKind quad_kind(float largest_radius_px) {
  return largest_radius_px < 1                 ? QuadKind::thin
         : largest_radius_px < least_relief_px ? QuadKind::round
                                               : QuadKind::near;
}

// The vertices of a segment, and the corners of its triangles (3 per triangle).
constexpr int quad_vertices(QuadKind kind) {
  return kind == QuadKind::round ? 8 : 4;
}
constexpr int quad_corners(QuadKind kind) {
  return kind == QuadKind::round ? 18 : 6;
}
// The index buffer's capacity in segments, with either number of vertices: within 16-bit indices.
inline constexpr int most_quads = 4096;
std::vector<std::uint16_t> quad_indices(QuadKind kind, int segments);

// Threads: as gl/objects.h.
class QuadPrograms {
public:
  // The vertex stage is `vertex_head`, shaders/vessels/vessel_quad.glsl and `vertex_main`.
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<QuadPrograms> create(std::string_view name, std::string_view vertex_head,
                                          std::string_view vertex_main);

  void begin(const VesselFrame& frame) const;
  void use(QuadKind kind) const { programs_[static_cast<std::size_t>(kind)].use(); }

private:
  using Programs = std::array<gl::Program, quad_kind_count>;
  explicit QuadPrograms(Programs programs) : programs_{std::move(programs)} {}

  Programs programs_;
};

} // namespace octascope::ui
