#include "pipeline/surface/cube_triangles.h"

#include <cstddef>
#include <utility>

namespace octascope::pipeline {

namespace {

constexpr int no_edge = -1;

constexpr int edge_between(int corner, int other) {
  for (int edge = 0; edge < cube_edges; ++edge) {
    const int from = cube_edge_corner(edge);
    const int to = from | 1 << (edge / 4);
    if ((from == corner && to == other) || (from == other && to == corner))
      return edge;
  }
  return no_edge;
}

// The corners of face 2·axis + side, counter-clockwise seen from outside.
constexpr std::array<int, 4> face_corners(int face) {
  const int axis = face / 2;
  const bool far = face % 2 == 1;
  const int u = 1 << (axis + 1) % 3;
  const int v = 1 << (axis + 2) % 3;
  const int base = far ? 1 << axis : 0;
  return far ? std::array{base, base | u, base | u | v, base | v}
             : std::array{base, base | v, base | u | v, base | u};
}

constexpr bool share_a_face(int edge, int other) {
  for (int face = 0; face < 6; ++face) {
    const auto corners = face_corners(face);
    bool has_edge = false;
    bool has_other = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const int on_face = edge_between(corners[i], corners[(i + 1) % 4]);
      has_edge = has_edge || on_face == edge;
      has_other = has_other || on_face == other;
    }
    if (has_edge && has_other)
      return true;
  }
  return false;
}

// Around each face, the surface's line runs from where a run of inside corners begins to where it
// ends; the edge that it comes to is where the next face's line begins.
constexpr std::array<int, cube_edges> trace_lines(int inside) {
  std::array<int, cube_edges> next{};
  next.fill(no_edge);
  const auto is_inside = [&](int corner) { return (inside >> corner & 1) != 0; };
  for (int face = 0; face < 6; ++face) {
    const auto corners = face_corners(face);
    for (std::size_t start = 0; start < 4; ++start) {
      if (is_inside(corners[(start + 3) % 4]) || !is_inside(corners[start]))
        continue;
      std::size_t end = start;
      while (is_inside(corners[(end + 1) % 4]))
        end = (end + 1) % 4;
      const int enters = edge_between(corners[(start + 3) % 4], corners[start]);
      const int leaves = edge_between(corners[end], corners[(end + 1) % 4]);
      next[static_cast<std::size_t>(enters)] = leaves;
    }
  }
  return next;
}

struct Loop {
  std::array<int, cube_edges> edges{};
  std::size_t size = 0;
};

// Cuts corner after corner off a loop, such that no cut runs across a face; false if that is not
// possible.
constexpr bool triangulate(const Loop& loop, CubeTriangles& triangles) {
  if (loop.size < 3)
    return true;
  for (std::size_t i = 0; i < loop.size; ++i) {
    const int before = loop.edges[(i + loop.size - 1) % loop.size];
    const int after = loop.edges[(i + 1) % loop.size];
    if (loop.size > 3 && share_a_face(before, after))
      continue;
    CubeTriangles cut = triangles;
    auto* at = cut.edges.data() + 3 * static_cast<std::size_t>(cut.count++);
    at[0] = static_cast<std::uint8_t>(before);
    at[1] = static_cast<std::uint8_t>(loop.edges[i]);
    at[2] = static_cast<std::uint8_t>(after);
    Loop rest;
    for (std::size_t k = 0; k < loop.size; ++k)
      if (k != i)
        rest.edges[rest.size++] = loop.edges[k];
    if (loop.size == 3)
      rest.size = 0;
    if (triangulate(rest, cut)) {
      triangles = cut;
      return true;
    }
  }
  return false;
}

struct Table {
  std::array<CubeTriangles, 256> cases{};
  bool complete = true;
};

constexpr Table make_table() {
  Table table;
  for (int inside = 0; inside < 256; ++inside) {
    auto next = trace_lines(inside);
    for (int first = 0; first < cube_edges; ++first) {
      Loop loop;
      for (int edge = first; next[static_cast<std::size_t>(edge)] != no_edge;) {
        loop.edges[loop.size++] = edge;
        edge = std::exchange(next[static_cast<std::size_t>(edge)], no_edge);
      }
      table.complete =
          triangulate(loop, table.cases[static_cast<std::size_t>(inside)]) && table.complete;
    }
  }
  return table;
}

constexpr Table table = make_table();
static_assert(table.complete, "some loop cannot be cut up without crossing a face");

} // namespace

constexpr std::array<CubeTriangles, 256> cube_triangles = table.cases;

} // namespace octascope::pipeline
