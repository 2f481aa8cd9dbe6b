// How a surface crosses a cube, for each of the 256 ways in which its corners lie inside or
// outside.
//
// Source: W. E. Lorensen, H. E. Cline, "Marching cubes" (SIGGRAPH 1987). The table is computed,
// from one rule, when the program is compiled: on each face, a line cuts off each run of corners
// that are inside. Two cubes see their common face alike, so that surfaces have no cracks; and no
// triangle has an edge of its own across a face, so that each edge has exactly two triangles.
#pragma once

#include <array>
#include <cstdint>

namespace octascope::pipeline {

// Corner c lies at (c & 1, c >> 1 & 1, c >> 2 & 1) along depth, fast and slow axis. Edge
// 4·axis + k runs along its axis from cube_edge_corner(edge); k counts the other two axes, the
// earlier one first.
inline constexpr int cube_edges = 12;

constexpr int cube_edge_corner(int edge) {
  const int axis = edge / 4;
  const int first = axis == 0 ? 1 : 0;
  const int second = axis == 2 ? 1 : 2;
  return (edge & 1) << first | (edge >> 1 & 1) << second;
}

struct CubeTriangles {
  static constexpr int most = 10; // more than there are
  std::uint8_t count = 0;
  // Three edges a triangle, counter-clockwise seen from outside in a right-handed (depth, fast,
  // slow).
  std::array<std::uint8_t, std::size_t{3} * most> edges{};
};

// Bit c of the index: corner c is inside.
extern const std::array<CubeTriangles, 256> cube_triangles;

} // namespace octascope::pipeline
