#include "pipeline/surface/iso_surface.h"

#include <algorithm>
#include <cmath>

#include "pipeline/surface/cube_triangles.h"

namespace octascope::pipeline {

namespace {

constexpr std::uint32_t none = 0xFFFF'FFFFU;

using Vector = std::array<float, 3>;

std::size_t index_of(const IsoGrid& grid, int z, int a, int b) {
  return (static_cast<std::size_t>(b) * static_cast<std::size_t>(grid.a_scans) +
          static_cast<std::size_t>(a)) *
             static_cast<std::size_t>(grid.depths) +
         static_cast<std::size_t>(z);
}

// Central differences, one-sided at borders and beside missing B-scans; per mm.
Vector gradient(const IsoGrid& grid, int z, int a, int b) {
  const auto slope = [&](int low, int high, auto&& index, float cell_mm) {
    const auto at = [&](int i) { return static_cast<float>(grid.levels[index(i)]); };
    return high > low ? (at(high) - at(low)) / (static_cast<float>(high - low) * cell_mm) : 0.0F;
  };
  const auto present = [&](int i) {
    return i >= 0 && i < grid.b_scans && grid.present[static_cast<std::size_t>(i)] != 0;
  };
  return {slope(
              std::max(z - 1, 0), std::min(z + 1, grid.depths - 1),
              [&](int i) { return index_of(grid, i, a, b); }, grid.cell_mm[0]),
          slope(
              std::max(a - 1, 0), std::min(a + 1, grid.a_scans - 1),
              [&](int i) { return index_of(grid, z, i, b); }, grid.cell_mm[1]),
          slope(
              present(b - 1) ? b - 1 : b, present(b + 1) ? b + 1 : b,
              [&](int i) { return index_of(grid, z, a, i); }, grid.cell_mm[2])};
}

std::array<std::int16_t, 3> packed_normal(const Vector& gradient) {
  const float length = std::hypot(gradient[0], gradient[1], gradient[2]);
  const float scale = length > 0 ? -32767 / length : 0;
  std::array<std::int16_t, 3> packed{};
  for (std::size_t i = 0; i < 3; ++i)
    packed[i] = static_cast<std::int16_t>(std::lround(gradient[i] * scale));
  return packed;
}

float triangle_area(const Vector& p, const Vector& q, const Vector& r) {
  const Vector u{q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  const Vector v{r[0] - p[0], r[1] - p[1], r[2] - p[2]};
  return std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                    u[0] * v[1] - u[1] * v[0]) /
         2;
}

} // namespace

void IsoExtractor::begin(const IsoGrid& grid, float level, IsoMesh& mesh) {
  mesh.clear();
  mesh.extents_mm = grid.extents_mm;
  // Between two whole values, so that no sample ever lies on the surface.
  threshold_ = static_cast<std::uint32_t>(std::clamp(std::ceil(level * 256), 0.0F, 65536.0F));
  for (std::size_t i = 0; i < 2; ++i) {
    along_depth_[i].assign(grid.slice(), none);
    along_a_[i].assign(grid.slice(), none);
  }
  along_b_.resize(grid.slice());
}

void IsoExtractor::extract_slab(const IsoGrid& grid, const Occupancy& occupancy, int b,
                                IsoMesh& mesh) {
  const auto slab = static_cast<std::size_t>(b);
  const std::size_t far = (slab + 1) % 2;
  std::ranges::fill(along_depth_[far], none);
  std::ranges::fill(along_a_[far], none);
  std::ranges::fill(along_b_, none);
  if (grid.present[slab] == 0 || grid.present[slab + 1] == 0)
    return;
  const int bricks = occupancy.bricks().depth;
  for (int a = 0; a + 1 < grid.a_scans; ++a) {
    const auto row =
        static_cast<std::size_t>((a + 1) >> brick_a_shift) * static_cast<std::size_t>(bricks);
    for (int brick = 0; brick < bricks; ++brick) {
      const std::size_t at = row + static_cast<std::size_t>(brick);
      const unsigned lowest = std::min(occupancy.lowest(b)[at], occupancy.lowest(b + 1)[at]);
      const unsigned highest = std::max(occupancy.highest(b)[at], occupancy.highest(b + 1)[at]);
      if (lowest * 256 >= threshold_ || highest * 256 + 255 < threshold_)
        continue;
      const int first = brick << brick_depth_shift;
      extract_cells(grid, {first, a, b},
                    std::min((brick + 1) << brick_depth_shift, grid.depths - 1), mesh);
    }
  }
}

// Cells along depth from `first` to before `end`.
void IsoExtractor::extract_cells(const IsoGrid& grid, Cell first, int end, IsoMesh& mesh) {
  const std::uint16_t* near = grid.levels.data() + index_of(grid, 0, first.a, first.b);
  const std::uint16_t* far = near + grid.slice();
  const auto pitch = static_cast<std::size_t>(grid.depths);
  const auto corners_at = [&](int depth) {
    const auto z = static_cast<std::size_t>(depth);
    return unsigned{near[z] >= threshold_} | unsigned{near[z + pitch] >= threshold_} << 2U |
           unsigned{far[z] >= threshold_} << 4U | unsigned{far[z + pitch] >= threshold_} << 6U;
  };
  unsigned here = corners_at(first.z);
  for (Cell cell = first; cell.z < end; ++cell.z) {
    const unsigned next = corners_at(cell.z + 1);
    const unsigned inside = here | next << 1U;
    here = next;
    if (inside != 0 && inside != 255)
      add_triangles(grid, cell, inside, mesh);
  }
}

void IsoExtractor::add_triangles(const IsoGrid& grid, const Cell& cell, unsigned inside,
                                 IsoMesh& mesh) {
  const CubeTriangles& triangles = cube_triangles[inside];
  for (std::size_t i = 0; i < std::size_t{3} * triangles.count; ++i)
    mesh.corners.push_back(vertex_on(grid, cell, triangles.edges[i], mesh));
}

std::uint32_t IsoExtractor::vertex_on(const IsoGrid& grid, const Cell& cell, int edge,
                                      IsoMesh& mesh) {
  const int corner = cube_edge_corner(edge);
  const Cell from{cell.z + (corner & 1), cell.a + (corner >> 1 & 1), cell.b + (corner >> 2 & 1)};
  const int axis = edge / 4;
  const auto slice = static_cast<std::size_t>(from.b % 2);
  std::vector<std::uint32_t>& known = axis == 0   ? along_depth_[slice]
                                      : axis == 1 ? along_a_[slice]
                                                  : along_b_;
  std::uint32_t& vertex = known[index_of(grid, from.z, from.a, 0)];
  if (vertex == none) {
    vertex = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(make_vertex(grid, from, axis));
  }
  return vertex;
}

IsoVertex IsoExtractor::make_vertex(const IsoGrid& grid, const Cell& from, int axis) const {
  Cell to = from;
  ++(axis == 0 ? to.z : axis == 1 ? to.a : to.b);
  const auto level = [&](const Cell& at) {
    return static_cast<float>(grid.levels[index_of(grid, at.z, at.a, at.b)]);
  };
  const float share =
      (static_cast<float>(threshold_) - 0.5F - level(from)) / (level(to) - level(from));
  const Vector near = gradient(grid, from.z, from.a, from.b);
  const Vector far = gradient(grid, to.z, to.a, to.b);
  const std::array place{from.z, from.a, from.b};
  IsoVertex vertex{};
  Vector slope{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float along =
        static_cast<float>(place[i]) + (i == static_cast<std::size_t>(axis) ? share : 0);
    vertex.position_mm[i] = grid.first_mm[i] + along * grid.cell_mm[i];
    slope[i] = std::lerp(near[i], far[i], share);
  }
  // Where two slopes cancel out, the edge itself tells where the level falls.
  if (slope == Vector{})
    slope[static_cast<std::size_t>(axis)] = level(to) - level(from);
  vertex.normal = packed_normal(slope);
  return vertex;
}

std::uint32_t IsoCleaner::root_of(std::uint32_t vertex) {
  while (parents_[vertex] != vertex)
    vertex = parents_[vertex] = parents_[parents_[vertex]];
  return vertex;
}

void IsoCleaner::drop_small_pieces(float least_area_mm2, IsoMesh& mesh) {
  parents_.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < parents_.size(); ++i)
    parents_[i] = static_cast<std::uint32_t>(i);
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    const std::uint32_t root = root_of(mesh.corners[i]);
    parents_[root_of(mesh.corners[i + 1])] = root;
    parents_[root_of(mesh.corners[i + 2])] = root;
  }
  areas_.assign(mesh.vertices.size(), 0);
  const auto position = [&](std::size_t corner) -> const Vector& {
    return mesh.vertices[mesh.corners[corner]].position_mm;
  };
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    areas_[root_of(mesh.corners[i])] +=
        triangle_area(position(i), position(i + 1), position(i + 2));

  const auto stays = [&](std::uint32_t vertex) {
    return areas_[root_of(vertex)] >= least_area_mm2;
  };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    if (stays(mesh.corners[i])) {
      std::copy_n(mesh.corners.begin() + static_cast<std::ptrdiff_t>(i), 3,
                  mesh.corners.begin() + static_cast<std::ptrdiff_t>(kept));
      kept += 3;
    }
  mesh.corners.resize(kept);
  places_.resize(mesh.vertices.size());
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
    if (stays(i)) {
      mesh.vertices[next] = mesh.vertices[i];
      places_[i] = next++;
    }
  mesh.vertices.resize(next);
  for (std::uint32_t& corner : mesh.corners)
    corner = places_[corner];
}

} // namespace octascope::pipeline
