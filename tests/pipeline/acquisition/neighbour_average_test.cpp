#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/neighbour_average.h"
#include "pipeline/volume/volume.h"
#include "tests/support/allocation_counter.h"

namespace octascope::pipeline {
namespace {

Volume random_volume(const VolumeGeometry& geometry, unsigned seed) {
  Volume volume{geometry};
  std::mt19937 generator{seed};
  for (auto& level : volume.levels)
    level = static_cast<std::uint8_t>(generator());
  std::fill(volume.b_scan_states.begin(), volume.b_scan_states.end(), BScanState::good);
  return volume;
}

// By its definition, in double precision.
std::vector<double> exact_average(const Volume& volume, const NeighbourWeights& w) {
  std::vector<double> result(volume.levels.size());
  const int b_scans = volume.geometry.b_scans;
  const auto there = [&](int b) {
    return b >= 0 && b < b_scans &&
           volume.b_scan_states[static_cast<std::size_t>(b)] != BScanState::missing;
  };
  for (int b = 0; b < b_scans; ++b) {
    const std::size_t voxels = volume.geometry.b_scan_voxels();
    for (std::size_t i = 0; i < voxels; ++i) {
      const auto level = [&](int from) { return static_cast<double>(volume.b_scan(from)[i]); };
      double sum = w.here * level(b);
      double weight = w.here;
      if (there(b - 1))
        sum += w.before * level(b - 1), weight += w.before;
      if (there(b + 1))
        sum += w.after * level(b + 1), weight += w.after;
      result[static_cast<std::size_t>(b) * voxels + i] = there(b) ? sum / weight : level(b);
    }
  }
  return result;
}

// What comes of each B-scan; missing ones stay as they are.
std::vector<std::uint8_t> average_all(const NeighbourAverage& average, const Volume& volume) {
  std::vector<std::uint8_t> result = volume.levels;
  const std::size_t voxels = volume.geometry.b_scan_voxels();
  const auto levels = [&](int b) {
    const bool there = b >= 0 && b < volume.geometry.b_scans &&
                       volume.b_scan_states[static_cast<std::size_t>(b)] != BScanState::missing;
    return there ? volume.b_scan(b) : std::span<const std::uint8_t>{};
  };
  for (int b = 0; b < volume.geometry.b_scans; ++b)
    if (!levels(b).empty())
      average.average(levels(b - 1), levels(b), levels(b + 1),
                      std::span{result}.subspan(static_cast<std::size_t>(b) * voxels, voxels));
  return result;
}

void expect_exact(const Volume& volume, const NeighbourWeights& weights) {
  const auto exact = exact_average(volume, weights);
  const auto average = NeighbourAverage::create(weights);
  ASSERT_TRUE(average);
  const std::vector<std::uint8_t> found = average_all(*average, volume);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    // The nearest count; at a tie of the exact value either neighbour.
    ASSERT_NEAR(found[i], exact[i], 0.5 + 0.01) << i;
  }
}

// Not a multiple of any register.
constexpr VolumeGeometry geometry{101, 97, 7, 1, 1, 1};

TEST(NeighbourAverage, is_the_weighted_mean_with_edges_renormalised) {
  expect_exact(random_volume(geometry, 1), {});
  expect_exact(random_volume(geometry, 2), {1, 5, 3.3});
  expect_exact(random_volume(geometry, 3), {0, 1, 0});
  expect_exact(random_volume(geometry, 4), {0.7, 0.1, 0});
}

TEST(NeighbourAverage, missing_b_scans_stay_missing_and_count_for_nothing) {
  Volume volume = random_volume(geometry, 5);
  volume.b_scan_states[0] = BScanState::missing;
  volume.b_scan_states[3] = BScanState::missing;
  volume.b_scan_states[5] = BScanState::saturated;
  expect_exact(volume, {});
  volume.b_scan_states[4] = BScanState::missing;
  volume.b_scan_states[6] = BScanState::missing;
  expect_exact(volume, {});
}

TEST(NeighbourAverage, small_volumes_work) {
  expect_exact(random_volume({3, 1, 1, 1, 1, 1}, 6), {});
  expect_exact(random_volume({1, 1, 2, 1, 1, 1}, 7), {});
}

TEST(NeighbourAverage, allocates_nothing) {
  Volume volume = random_volume(geometry, 8);
  const auto average = NeighbourAverage::create({});
  std::vector<std::uint8_t> result(volume.geometry.b_scan_voxels());
  const auto before = tests::allocations_of_this_thread();
  average->average(volume.b_scan(0), volume.b_scan(1), volume.b_scan(2), result);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
}

TEST(NeighbourAverage, refuses_weights_that_make_no_sense) {
  EXPECT_FALSE(NeighbourAverage::create({0.25, 0, 0.25}));
  EXPECT_FALSE(NeighbourAverage::create({-1, 1, 1}));
  EXPECT_FALSE(NeighbourAverage::create({std::nan(""), 1, 1}));
}

TEST(NeighbourAverage, rounds_to_the_nearest) {
  Volume volume{{1, 1, 3, 1, 1, 1}};
  volume.levels = {10, 11, 11};
  volume.b_scan_states.assign(3, BScanState::good);
  EXPECT_EQ(average_all(*NeighbourAverage::create({}), volume),
            (std::vector<std::uint8_t>{10, 11, 11})); // 10.33, 10.75, 11
}

} // namespace
} // namespace octascope::pipeline
