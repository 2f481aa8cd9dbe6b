// The triangles of tubes, for both expanders.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "ui/gl/program.h"
#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// A segment is a strip of triangles between two rings, with half balls at ends that do not
// continue.
struct TubeShape {
  int sectors = 8; // around the axis, 4 to 32; even, so that two edges lie on the outline

  int cap_rings() const { return sectors < 8 ? 1 : sectors / 4; } // from equator to pole
  int body_vertices() const { return 2 * sectors; }
  int cap_vertices() const { return (cap_rings() + 1) * sectors; }
};

// Indices of triangle strips, joined by degenerate triangles, for that many bodies or half balls
// with consecutive vertices; and the number of indices of one.
std::vector<std::uint32_t> tube_body_indices(const TubeShape& shape, int segments);
std::vector<std::uint32_t> tube_cap_indices(const TubeShape& shape, int caps);
int tube_body_corners(const TubeShape& shape);
int tube_cap_corners(const TubeShape& shape);

// Smaller half balls are invisible. They are not drawn for clusters in which none is larger.
inline constexpr float smallest_cap_px = 0.35F;
// At a bend without a half ball, this much of the outline may be missing.
inline constexpr float straight_px = 0.25F;

// ErrorCode::unsupported: this GL cannot compile the shaders.
hal::Result<gl::Program> build_tube_program(std::string_view name, std::string_view defines,
                                            std::string_view vertex_head,
                                            std::string_view vertex_main);

} // namespace octascope::ui
