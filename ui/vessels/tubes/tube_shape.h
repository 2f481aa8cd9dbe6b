// The triangles of tubes, whoever expands them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "ui/gl/program.h"
#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// A segment is a strip of triangles between two rings, with a half ball at each end where it does
// not go on.
struct TubeShape {
  int sectors = 8; // around the axis; even, so that two edges lie on the outline. 4 to 32

  int cap_rings() const { return sectors < 8 ? 1 : sectors / 4; } // from equator to pole
  int body_vertices() const { return 2 * sectors; }
  int cap_vertices() const { return (cap_rings() + 1) * sectors; }
};

// Strips of that many bodies or half balls, joined by degenerate triangles, with their vertices one
// after the other; and the number of indices of one.
std::vector<std::uint32_t> tube_body_indices(const TubeShape& shape, int segments);
std::vector<std::uint32_t> tube_cap_indices(const TubeShape& shape, int caps);
int tube_body_corners(const TubeShape& shape);
int tube_cap_corners(const TubeShape& shape);

// Half balls smaller than this are invisible and not drawn, in clusters that have no larger one.
inline constexpr float smallest_cap_px = 0.35F;
// How much of the outline a bend without a half ball may lack.
inline constexpr float straight_px = 0.25F;

// ErrorCode::unsupported: this GL cannot compile our shaders.
hal::Result<gl::Program> build_tube_program(std::string_view name, std::string_view defines,
                                            std::string_view vertex_head,
                                            std::string_view vertex_main);

} // namespace octascope::ui
