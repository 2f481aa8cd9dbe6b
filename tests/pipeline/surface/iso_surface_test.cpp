// Surfaces against closed forms, and whether their triangles hang together.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "pipeline/surface/cube_triangles.h"
#include "pipeline/surface/iso_surface.h"

namespace octascope::pipeline {
namespace {

using Vector = std::array<double, 3>;

Vector operator-(const Vector& p, const Vector& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
double dot(const Vector& p, const Vector& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
Vector cross(const Vector& p, const Vector& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
double length(const Vector& p) {
  return std::sqrt(dot(p, p));
}

IsoGrid make_grid(int depths, int a_scans, int b_scans, std::array<float, 3> cell_mm) {
  IsoGrid grid;
  grid.depths = depths;
  grid.a_scans = a_scans;
  grid.b_scans = b_scans;
  grid.cell_mm = cell_mm;
  grid.first_mm = {0.5F * cell_mm[0], 0.5F * cell_mm[1], 0.5F * cell_mm[2]};
  grid.levels.resize(grid.slice() * static_cast<std::size_t>(b_scans));
  grid.present.assign(static_cast<std::size_t>(b_scans), 1);
  return grid;
}

// `level` in counts, of a place in mm.
void fill(IsoGrid& grid, const std::function<double(const Vector&)>& level) {
  std::size_t i = 0;
  for (int b = 0; b < grid.b_scans; ++b)
    for (int a = 0; a < grid.a_scans; ++a)
      for (int z = 0; z < grid.depths; ++z) {
        Vector at{};
        const std::array index{z, a, b};
        for (std::size_t k = 0; k < 3; ++k)
          at[k] = static_cast<double>(grid.first_mm[k]) +
                  index[k] * static_cast<double>(grid.cell_mm[k]);
        grid.levels[i++] =
            static_cast<std::uint16_t>(std::lround(std::clamp(level(at), 0.0, 255.0) * 256));
      }
}

IsoMesh extract(const IsoGrid& grid, float level) {
  Occupancy occupancy;
  std::vector<std::uint8_t> counts;
  update_occupancy(grid, occupancy, counts);
  IsoExtractor extractor;
  IsoMesh mesh;
  EXPECT_TRUE(extractor.extract(grid, occupancy, level, mesh, [] { return false; }));
  return mesh;
}

Vector position(const IsoMesh& mesh, std::uint32_t vertex) {
  const auto& p = mesh.vertices[vertex].position_mm;
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

std::array<Vector, 3> triangle(const IsoMesh& mesh, std::size_t i) {
  return {position(mesh, mesh.corners[3 * i]), position(mesh, mesh.corners[3 * i + 1]),
          position(mesh, mesh.corners[3 * i + 2])};
}

// How often each edge is walked along in its direction.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed_edges(const IsoMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k)
      ++edges[{mesh.corners[i + k], mesh.corners[i + (k + 1) % 3]}];
  return edges;
}

// Every edge has two triangles, of which each walks along it in its own direction; but those for
// which on_border says that both ends may be where the surface ends have one at least.
void expect_joined(const IsoMesh& mesh, const std::function<bool(const Vector&)>& on_border) {
  const auto edges = directed_edges(mesh);
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << edge.first << " to " << edge.second;
    if (!edges.contains({edge.second, edge.first})) {
      ASSERT_TRUE(on_border(position(mesh, edge.first)) && on_border(position(mesh, edge.second)));
    }
  }
}

bool nowhere(const Vector&) {
  return false;
}

TEST(CubeTriangles, are_none_for_a_cube_that_is_all_one) {
  EXPECT_EQ(cube_triangles[0].count, 0);
  EXPECT_EQ(cube_triangles[255].count, 0);
}

// A loop of n corners takes n − 2 triangles, and all that crosses is used.
TEST(CubeTriangles, use_exactly_the_edges_that_the_surface_crosses) {
  for (unsigned inside = 0; inside < 256; ++inside) {
    std::array<int, cube_edges> used{};
    for (std::size_t i = 0; i < std::size_t{3} * cube_triangles[inside].count; ++i)
      ++used[cube_triangles[inside].edges[i]];
    for (int edge = 0; edge < cube_edges; ++edge) {
      const int from = cube_edge_corner(edge);
      const int to = from | 1 << edge / 4;
      const bool crosses = (inside >> from & 1) != (inside >> to & 1);
      EXPECT_EQ(used[static_cast<std::size_t>(edge)] > 0, crosses) << inside << ", edge " << edge;
    }
    EXPECT_LE(cube_triangles[inside].count, 5);
  }
}

class Sphere : public testing::Test {
protected:
  static constexpr std::array<float, 3> cell{0.014F, 0.020F, 0.0375F};
  static constexpr Vector centre{0.452, 0.503, 0.511};
  static constexpr double radius = 0.4;

  Sphere() : grid_{make_grid(64, 50, 27, cell)} {
    fill(grid_, [](const Vector& p) { return 120 - 150 * (length(p - centre) - radius); });
    mesh_ = extract(grid_, 120);
  }
  IsoGrid grid_;
  IsoMesh mesh_;
};

TEST_F(Sphere, has_its_corners_on_the_surface) {
  ASSERT_GT(mesh_.triangles(), 1000U);
  for (std::uint32_t i = 0; i < mesh_.vertices.size(); ++i)
    ASSERT_NEAR(length(position(mesh_, i) - centre), radius, 0.1 * 0.014);
}

TEST_F(Sphere, has_area_and_volume_to_one_per_cent) {
  double area = 0;
  double volume = 0;
  for (std::size_t i = 0; i < mesh_.triangles(); ++i) {
    const auto [p, q, r] = triangle(mesh_, i);
    const Vector normal = cross(q - p, r - p);
    area += length(normal) / 2;
    volume += dot(p - centre, normal) / 6; // positive where the triangle faces outwards
  }
  const double pi = std::numbers::pi;
  EXPECT_NEAR(area, 4 * pi * radius * radius, 0.01 * 4 * pi * radius * radius);
  EXPECT_NEAR(volume, 4 * pi / 3 * std::pow(radius, 3), 0.01 * 4 * pi / 3 * std::pow(radius, 3));
}

TEST_F(Sphere, is_closed_and_in_one_piece) {
  expect_joined(mesh_, nowhere);
  const auto edges = directed_edges(mesh_).size() / 2;
  EXPECT_EQ(static_cast<int>(mesh_.vertices.size()) - static_cast<int>(edges) +
                static_cast<int>(mesh_.triangles()),
            2)
      << "Euler's characteristic";
}

TEST_F(Sphere, has_normals_that_point_outwards) {
  for (std::uint32_t i = 0; i < mesh_.vertices.size(); ++i) {
    const auto& n = mesh_.vertices[i].normal;
    const Vector normal{n[0] / 32767.0, n[1] / 32767.0, n[2] / 32767.0};
    const Vector outwards = position(mesh_, i) - centre;
    ASSERT_NEAR(length(normal), 1, 1e-3);
    ASSERT_GT(dot(normal, outwards) / length(outwards), 0.999);
  }
}

TEST_F(Sphere, is_not_seen_at_levels_that_it_does_not_reach) {
  EXPECT_EQ(extract(grid_, 250).triangles(), 0U);
  EXPECT_EQ(extract(grid_, 0).triangles(), 0U);
  EXPECT_EQ(extract(grid_, -10).triangles(), 0U);
  EXPECT_EQ(extract(grid_, 300).triangles(), 0U);
}

TEST_F(Sphere, with_missing_b_scans_is_open_there_and_only_there) {
  grid_.present[10] = 0;
  const IsoMesh open = extract(grid_, 120);
  const double below = static_cast<double>(grid_.first_mm[2] + 9 * grid_.cell_mm[2]);
  const double above = static_cast<double>(grid_.first_mm[2] + 11 * grid_.cell_mm[2]);
  expect_joined(open, [&](const Vector& p) {
    return std::abs(p[2] - below) < 1e-5 || std::abs(p[2] - above) < 1e-5;
  });
  for (std::uint32_t i = 0; i < open.vertices.size(); ++i) {
    const Vector p = position(open, i);
    ASSERT_TRUE(p[2] < below + 1e-5 || p[2] > above - 1e-5) << "nothing where nothing was measured";
    ASSERT_NEAR(length(p - centre), radius, 0.1 * 0.014);
  }
  EXPECT_LT(open.triangles(), mesh_.triangles());
}

TEST(IsoSurface, of_a_slope_is_a_plane_with_its_normal) {
  IsoGrid grid = make_grid(20, 12, 9, {0.01F, 0.02F, 0.03F});
  const Vector up{-0.8, 0.36, 0.48}; // of unit length; the level rises the other way
  fill(grid, [&](const Vector& p) { return 128 - 600 * (dot(p, up) + 0.01); });
  const IsoMesh mesh = extract(grid, 128);
  ASSERT_GT(mesh.triangles(), 50U);
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    ASSERT_NEAR(dot(position(mesh, i), up), -0.01, 1e-5);
    const auto& n = mesh.vertices[i].normal;
    ASSERT_GT((n[0] * up[0] + n[1] * up[1] + n[2] * up[2]) / 32767, 0.9999);
  }
}

TEST(IsoSurface, of_a_step_lies_halfway_and_of_two_b_scans_is_a_ribbon) {
  IsoGrid grid = make_grid(6, 4, 2, {1, 1, 1});
  fill(grid, [](const Vector& p) { return p[0] > 3 ? 200 : 100; }); // between samples 2 and 3
  const IsoMesh mesh = extract(grid, 150);
  EXPECT_EQ(mesh.triangles(), 6U) << "three cells, two triangles each";
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i)
    EXPECT_NEAR(position(mesh, i)[0], 3, 1e-4);
}

TEST(IsoSurface, of_what_has_no_cells_is_nothing) {
  for (const auto [depths, a_scans, b_scans] :
       {std::array{8, 8, 1}, std::array{1, 8, 8}, std::array{8, 1, 8}, std::array{0, 8, 8}}) {
    IsoGrid grid = make_grid(depths, a_scans, b_scans, {1, 1, 1});
    std::mt19937 random{4};
    for (auto& level : grid.levels)
      level = static_cast<std::uint16_t>(random());
    EXPECT_EQ(extract(grid, 128).triangles(), 0U);
  }
}

// Noise has every one of the 256 cases, and all of them beside one another.
TEST(IsoSurface, of_noise_hangs_together_but_at_the_volume_s_border) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    IsoGrid grid = make_grid(19 + static_cast<int>(seed), 18, 17, {1, 1, 1});
    std::mt19937 random{seed};
    for (auto& level : grid.levels) {
      level = static_cast<std::uint16_t>(random());
      if (seed % 2 == 1) // and where many levels are the surface's own
        level = static_cast<std::uint16_t>(level % 3 * 128 * 128);
    }
    const IsoMesh mesh = extract(grid, seed % 2 == 1 ? 64 : 128);
    ASSERT_GT(mesh.triangles(), 5000U);
    const std::array last{grid.depths - 0.5, grid.a_scans - 0.5, grid.b_scans - 0.5};
    expect_joined(mesh, [&](const Vector& p) {
      for (std::size_t i = 0; i < 3; ++i)
        if (p[i] < 0.5 + 1e-6 || p[i] > last[i] - 1e-6)
          return true;
      return false;
    });
  }
}

TEST(IsoSurface, leaps_over_nothing_that_it_needs) {
  IsoGrid grid = make_grid(70, 33, 13, {1, 1, 1});
  std::ranges::fill(grid.levels, std::uint16_t{1000});
  std::mt19937 random{9};
  for (int i = 0; i < 40; ++i)
    grid.levels[random() % grid.levels.size()] = 60000;
  const IsoMesh mesh = extract(grid, 100);
  Occupancy everything{VolumeGeometry{70, 33, 13, 1, 1, 1}, 0};
  const std::vector<std::uint8_t> mixed = [&] {
    std::vector<std::uint8_t> counts(grid.slice());
    for (std::size_t i = 0; i < counts.size(); ++i)
      counts[i] = i % 2 == 0 ? 0 : 255;
    return counts;
  }();
  for (int b = 0; b < 13; ++b)
    everything.update(b, mixed);
  IsoExtractor extractor;
  IsoMesh whole;
  ASSERT_TRUE(extractor.extract(grid, everything, 100, whole, [] { return false; }));
  EXPECT_GT(mesh.triangles(), 200U);
  EXPECT_EQ(mesh.corners, whole.corners);
}

TEST(IsoSurface, may_be_abandoned_between_slabs) {
  IsoGrid grid = make_grid(8, 8, 8, {1, 1, 1});
  fill(grid, [](const Vector& p) { return 20 * p[0]; });
  Occupancy occupancy;
  std::vector<std::uint8_t> counts;
  update_occupancy(grid, occupancy, counts);
  IsoExtractor extractor;
  IsoMesh mesh;
  int asked = 0;
  EXPECT_FALSE(extractor.extract(grid, occupancy, 80, mesh, [&] { return ++asked == 4; }));
  EXPECT_EQ(asked, 4);
  EXPECT_TRUE(extractor.extract(grid, occupancy, 80, mesh, [] { return false; }));
  EXPECT_EQ(mesh.corners, extract(grid, 80).corners) << "nothing is left over";
}

TEST(IsoCleaner, drops_small_pieces_and_nothing_else) {
  IsoGrid grid = make_grid(40, 40, 40, {0.02F, 0.02F, 0.02F});
  const Vector large{0.3, 0.3, 0.3};
  const Vector small{0.65, 0.65, 0.65};
  const auto spheres = [&](bool both) {
    fill(grid, [&](const Vector& p) {
      const double first = 0.2 - length(p - large);
      const double second = both ? 0.05 - length(p - small) : -1;
      return 128 + 400 * std::max(first, second);
    });
    return extract(grid, 128);
  };
  const IsoMesh alone = spheres(false);
  IsoMesh mesh = spheres(true);
  ASSERT_GT(mesh.triangles(), alone.triangles());
  IsoCleaner cleaner;
  cleaner.drop_small_pieces(0.01F, mesh); // the small one has 0.031 mm²
  ASSERT_GT(mesh.triangles(), alone.triangles());
  cleaner.drop_small_pieces(0.1F, mesh);
  EXPECT_EQ(mesh.corners, alone.corners);
  ASSERT_EQ(mesh.vertices.size(), alone.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    EXPECT_EQ(mesh.vertices[i].position_mm, alone.vertices[i].position_mm);
}

} // namespace
} // namespace octascope::pipeline
