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
  thin,  // the depth is not flat at the round ends, which no pixel shows
  round, // writes the surface's own depth, which prevents the early depth test
};
inline constexpr int quad_kind_count = 2;

constexpr QuadKind quad_kind(float largest_radius_px) {
  return largest_radius_px < least_raised_px ? QuadKind::thin : QuadKind::round;
}

inline constexpr int quad_vertices = 4; // of a segment
inline constexpr int quad_corners = 6;  // of its triangles
// The index buffer's capacity in segments: within 16-bit indices.
inline constexpr int most_quads = 4096;
std::vector<std::uint16_t> quad_indices(int segments);

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
