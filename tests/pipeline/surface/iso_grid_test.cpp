#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/surface/iso_grid.h"

namespace octascope::pipeline {
namespace {

Volume noise_volume(const VolumeGeometry& geometry, unsigned seed) {
  Volume volume{geometry};
  std::ranges::fill(volume.b_scan_states, BScanState::good);
  std::mt19937 random{seed};
  for (auto& level : volume.levels)
    level = static_cast<std::uint8_t>(random());
  return volume;
}

IsoGrid grid_of(const Volume& volume, int first_depth) {
  IsoGrid grid;
  IsoGridMaker{}.make(volume, first_depth, grid);
  return grid;
}

TEST(IsoGrid, has_cells_that_are_about_as_long_along_all_axes) {
  EXPECT_EQ(iso_factors({512, 300, 80, 3.5, 10, 37.5}, 2), (std::array{4, 2, 1}));
  EXPECT_EQ(iso_factors({128, 100, 40, 14, 30, 75}, 2), (std::array{2, 1, 1}));
  EXPECT_EQ(iso_factors({64, 64, 64, 50, 50, 50}, 2), (std::array{1, 1, 1}));
  EXPECT_EQ(iso_factors({64, 64, 64, 5, 5, 5}, 0), (std::array{4, 4, 4})) << "20 µm at least";
}

TEST(IsoGrid, is_bounded_and_keeps_two_samples_along_each_axis) {
  const std::array<int, 3> huge = iso_factors({2048, 2000, 1000, 2, 20, 20}, 0);
  EXPECT_LE(2048 / huge[0] * (2000 / huge[1]) * (1000 / huge[2]), 4 << 20);
  EXPECT_EQ(iso_factors({7, 3, 2, 0.1, 0.1, 100}, 2), (std::array{2, 1, 1}));
}

// Against the mean of every voxel of a sample, in double precision.
TEST(IsoGrid, has_the_mean_of_its_voxels) {
  for (const VolumeGeometry& geometry :
       {VolumeGeometry{43, 9, 5, 3.5, 10, 37.5}, VolumeGeometry{20, 21, 22, 8, 8, 8},
        VolumeGeometry{30, 6, 5, 50, 50, 50}}) {
    constexpr int first_depth = 2;
    const Volume volume = noise_volume(geometry, 5);
    const auto f = iso_factors(geometry, first_depth);
    const IsoGrid grid = grid_of(volume, first_depth);
    ASSERT_EQ(grid.depths, (geometry.depths - first_depth) / f[0]);
    ASSERT_EQ(grid.a_scans, geometry.a_scans / f[1]);
    ASSERT_EQ(grid.b_scans, geometry.b_scans / f[2]);
    for (int b = 0; b < grid.b_scans; ++b)
      for (int a = 0; a < grid.a_scans; ++a)
        for (int z = 0; z < grid.depths; ++z) {
          double sum = 0;
          for (int k = 0; k < f[2]; ++k)
            for (int j = 0; j < f[1]; ++j)
              for (int i = 0; i < f[0]; ++i)
                sum += volume.b_scan(b * f[2] + k)[static_cast<std::size_t>(
                    (a * f[1] + j) * geometry.depths + first_depth + z * f[0] + i)];
          const double mean = sum * 256 / (f[0] * f[1] * f[2]);
          ASSERT_NEAR(grid.slice(b)[static_cast<std::size_t>(a * grid.depths + z)], mean, 0.51);
        }
  }
}

TEST(IsoGrid, knows_where_its_samples_lie) {
  const IsoGrid grid = grid_of(noise_volume({42, 8, 4, 5, 10, 40}, 1), 2);
  ASSERT_EQ(grid.depths, 10) << "four bins of 5 µm to a sample";
  EXPECT_FLOAT_EQ(grid.cell_mm[0], 0.020F);
  EXPECT_FLOAT_EQ(grid.first_mm[0], 0.020F) << "two bins left out, the middle of the next four";
  EXPECT_FLOAT_EQ(grid.first_mm[1], 0.010F);
  EXPECT_FLOAT_EQ(grid.first_mm[2], 0.020F);
  EXPECT_FLOAT_EQ(grid.extents_mm[0], 0.210F);
}

TEST(IsoGrid, smooths_a_line_to_the_binomials_and_keeps_what_is_level) {
  IsoGrid grid = grid_of(noise_volume({21, 21, 21, 60, 60, 60}, 1), 0);
  std::ranges::fill(grid.levels, std::uint16_t{16384});
  grid.levels[static_cast<std::size_t>((10 * 21 + 10) * 21 + 10)] = 16384 + 64 * 256;
  IsoSmoother smoother;
  ASSERT_TRUE(smoother.smooth(grid, [] { return false; }));
  const auto at = [&](int z, int a, int b) {
    return grid.slice(b)[static_cast<std::size_t>(a * 21 + z)] - 16384;
  };
  EXPECT_EQ(at(10, 10, 10), 8 * 256); // once along each axis: (1/2)³
  EXPECT_EQ(at(9, 10, 10), 4 * 256);
  EXPECT_EQ(at(10, 11, 9), 2 * 256);
  EXPECT_EQ(at(11, 11, 11), 256);
  EXPECT_EQ(at(12, 10, 10), 0);
  EXPECT_EQ(at(0, 0, 0), 0);
}

TEST(IsoGrid, smooths_no_missing_b_scan_into_its_neighbours) {
  Volume volume = noise_volume({20, 8, 7, 60, 60, 60}, 1);
  std::ranges::fill(volume.levels, std::uint8_t{100});
  volume.b_scan_states[3] = BScanState::missing;
  std::ranges::fill(volume.b_scan(3), std::uint8_t{0});
  IsoGrid grid = grid_of(volume, 0);
  ASSERT_TRUE(IsoSmoother{}.smooth(grid, [] { return false; }));
  for (int b = 0; b < 7; ++b) {
    EXPECT_EQ(grid.present[static_cast<std::size_t>(b)], b == 3 ? 0 : 1);
    for (const std::uint16_t level : grid.slice(b))
      ASSERT_EQ(level, b == 3 ? 0 : 25600);
  }
}

TEST(IsoGrid, calms_speckle_along_each_axis_over_the_same_length) {
  // A live volume's cells of 14, 20 and 37.5 µm: the spread of a point, in mm, is what counts.
  IsoGrid grid;
  grid.depths = grid.a_scans = grid.b_scans = 25;
  grid.cell_mm = {0.014F, 0.020F, 0.0375F};
  grid.levels.assign(25 * 25 * 25, 0);
  grid.present.assign(25, 1);
  grid.levels[static_cast<std::size_t>((12 * 25 + 12) * 25 + 12)] = 65535;
  ASSERT_TRUE(IsoSmoother{}.smooth(grid, [] { return false; }));
  std::array<double, 3> variance{};
  double sum = 0;
  for (int b = 0; b < 25; ++b)
    for (int a = 0; a < 25; ++a)
      for (int z = 0; z < 25; ++z) {
        const double weight = grid.slice(b)[static_cast<std::size_t>(a * 25 + z)];
        sum += weight;
        const std::array place{z - 12, a - 12, b - 12};
        for (std::size_t i = 0; i < 3; ++i)
          variance[i] += weight * std::pow(place[i] * static_cast<double>(grid.cell_mm[i]), 2);
      }
  for (const double v : variance)
    EXPECT_NEAR(std::sqrt(v / sum), 0.024, 0.005);
}

} // namespace
} // namespace octascope::pipeline
