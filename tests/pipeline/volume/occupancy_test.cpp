// Occupancy against brute force over cells.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/volume/occupancy.h"
#include "pipeline/volume/volume.h"

namespace octascope::tests {
namespace {

using pipeline::Occupancy;
using pipeline::VolumeGeometry;

pipeline::Volume noise_volume(const VolumeGeometry& geometry) {
  pipeline::Volume volume{geometry};
  std::mt19937 random{7};
  for (std::uint8_t& level : volume.levels)
    level = static_cast<std::uint8_t>(random() % 256);
  return volume;
}

class OccupancyOf : public testing::TestWithParam<VolumeGeometry> {};

INSTANTIATE_TEST_SUITE_P(Geometries, OccupancyOf,
                         testing::Values(VolumeGeometry{512, 30, 3, 1, 1, 1},
                                         VolumeGeometry{33, 17, 5, 1, 1, 1},
                                         VolumeGeometry{1, 1, 1, 1, 1, 1},
                                         VolumeGeometry{4100, 9, 2, 1, 1, 1}));

void expect_extremes_of_voxels(const VolumeGeometry& g, int first_depth) {
  SCOPED_TRACE(first_depth);
  const pipeline::Volume volume = noise_volume(g);
  Occupancy occupancy{g, first_depth};
  occupancy.update(volume);
  const auto bricks = occupancy.bricks();
  constexpr int brick_depths = 1 << pipeline::brick_depth_shift;
  constexpr int brick_a_scans = 1 << pipeline::brick_a_shift;
  constexpr int brick_b_scans = 1 << pipeline::brick_b_shift;
  EXPECT_EQ(bricks.depth, (g.depths + brick_depths - 1) / brick_depths);
  EXPECT_EQ(bricks.a, (g.a_scans + brick_a_scans) / brick_a_scans);
  EXPECT_EQ(bricks.b, (g.b_scans + brick_b_scans) / brick_b_scans);
  for (int b = 0; b < g.b_scans; ++b)
    for (int brick_a = 0; brick_a < bricks.a; ++brick_a)
      for (int brick_z = 0; brick_z < bricks.depth; ++brick_z) {
        int highest = -1;
        int lowest = 256;
        for (int a_cell = brick_a_scans * brick_a;
             a_cell < std::min(brick_a_scans * (brick_a + 1), g.a_scans + 1); ++a_cell)
          for (int z_cell = brick_depths * brick_z;
               z_cell < std::min(brick_depths * (brick_z + 1), g.depths); ++z_cell)
            for (const int a : {a_cell - 1, a_cell})
              for (const int z : {z_cell, z_cell + 1}) {
                if (a < 0 || a >= g.a_scans || z < first_depth || z >= g.depths)
                  continue;
                const int level = volume.b_scan(b)[static_cast<std::size_t>(a * g.depths + z)];
                highest = std::max(highest, level);
                lowest = std::min(lowest, level);
              }
        const auto at = static_cast<std::size_t>(brick_a * bricks.depth + brick_z);
        EXPECT_EQ(occupancy.highest(b)[at], std::max(highest, 0)) << brick_a << ' ' << brick_z;
        EXPECT_EQ(occupancy.lowest(b)[at], highest < 0 ? 0 : lowest) << brick_a << ' ' << brick_z;
      }
}

TEST_P(OccupancyOf, each_brick_has_the_extremes_of_the_voxels_that_touch_its_cells) {
  for (const int first_depth : {0, 2, 8, 9, 21})
    expect_extremes_of_voxels(GetParam(), first_depth);
}

TEST(Occupancy, a_b_scan_that_comes_again_replaces_what_it_said) {
  const VolumeGeometry g{32, 8, 2, 1, 1, 1};
  pipeline::Volume volume{g};
  Occupancy occupancy{g, 0};
  volume.b_scan(1)[5] = 90;
  occupancy.update(volume);
  EXPECT_EQ(occupancy.highest(1)[0], 90);
  EXPECT_EQ(occupancy.highest(0)[0], 0);
  volume.b_scan(1)[5] = 10;
  occupancy.update(1, volume.b_scan(1));
  EXPECT_EQ(occupancy.highest(1)[0], 10);
}

} // namespace
} // namespace octascope::tests
