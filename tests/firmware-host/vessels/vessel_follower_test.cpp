// A loaded tree that is kept where the tissue is by a thread beside the display.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/vessels/vessel_follower.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;

// 2.4 × 2.4 × 1 mm; coarse, as only its motion counts.
pipeline::Volume noise(unsigned seed) {
  pipeline::Volume made{{.depths = 64,
                         .a_scans = 64,
                         .b_scans = 64,
                         .depth_spacing_um = 16,
                         .a_spacing_um = 37.5,
                         .b_spacing_um = 37.5}};
  std::ranges::fill(made.b_scan_states, pipeline::BScanState::good);
  std::mt19937 random{seed};
  for (std::uint8_t& level : made.levels)
    level = static_cast<std::uint8_t>(random() % 200);
  return made;
}

pipeline::VesselTree bed(std::mt19937& random) {
  std::uniform_real_distribution<float> unit;
  pipeline::VesselTree tree;
  for (int i = 0; i < 14; ++i) {
    std::array<float, 3> at{0.4F + unit(random), 0.4F + unit(random), 0.2F + unit(random) * 0.6F};
    const float x = unit(random) - 0.3F, y = unit(random) - 0.3F, z = 0.3F * unit(random);
    const float step = 0.05F / std::sqrt(x * x + y * y + z * z);
    for (int j = 0; j < 20; ++j) {
      tree.positions_mm.push_back(at);
      tree.radii_mm.push_back(0.02F);
      tree.parents.push_back(j == 0 ? pipeline::no_parent
                                    : static_cast<std::uint32_t>(tree.nodes() - 2));
      tree.orders.push_back(0);
      tree.branches.push_back(pipeline::VesselBranch::unknown);
      at = {at[0] + step * x + 0.02F * (unit(random) - 0.5F),
            at[1] + step * y + 0.02F * (unit(random) - 0.5F), at[2] + step * z};
    }
  }
  return tree;
}

TEST(VesselFollower, says_where_a_tree_lies_once_one_was_traced) {
  std::mt19937 random{tests::fresh_seed()};
  const pipeline::VesselTree tree = bed(random);
  pipeline::ClusterArrays arrays = pipeline::build_clusters(tree);
  const LoadedVessels loaded{arrays, pipeline::facts_of(tree, arrays.error, "by lot")};
  const auto live = std::make_shared<LiveTree>();
  live->tree = tree;
  for (auto& at : live->tree.positions_mm)
    at[0] += 0.3F;

  hal::linux_backend::MonotonicClock clock;
  pipeline::Wakeup news;
  VesselFollower follower{loaded, {}, clock, news};
  pipeline::Volume volume = noise(1);
  const auto next_place = [&] {
    std::optional<pipeline::FollowedPlace> place;
    while (!(place = follower.take())) {
      ++volume.metadata.index;
      follower.offer(volume);
      std::this_thread::sleep_for(1ms);
    }
    return std::move(*place);
  };
  EXPECT_FALSE(next_place().volume_from_tree);
  live->number = 1;
  live->refusal = "too little";
  follower.offer(live);
  EXPECT_FALSE(next_place().volume_from_tree) << "a refused tree tells nothing";
  live->number = 2;
  live->refusal.clear();
  live->volume_index = volume.metadata.index;
  follower.offer(live);
  const pipeline::FollowedPlace place = next_place();
  ASSERT_TRUE(place.volume_from_tree) << place.refusal;
  EXPECT_NEAR(place.volume_from_tree->apply({0, 0, 0})[0], 0.3, 0.02);
  EXPECT_GT(place.overlap, 0.9);
  // Noise of another seed has nothing in common with it.
  std::ranges::copy(noise(2).levels, volume.levels.begin());
  EXPECT_FALSE(next_place().volume_from_tree);
}

TEST(VesselFollower, ends_while_it_looks_for_a_tree) {
  std::mt19937 random{tests::fresh_seed()};
  const pipeline::VesselTree tree = bed(random);
  pipeline::ClusterArrays arrays = pipeline::build_clusters(tree);
  const LoadedVessels loaded{arrays, pipeline::facts_of(tree, arrays.error, "by lot")};
  const auto live = std::make_shared<LiveTree>();
  live->tree = bed(random);
  live->number = 1;
  hal::linux_backend::MonotonicClock clock;
  pipeline::Wakeup news;
  VesselFollower follower{loaded, {}, clock, news};
  pipeline::Volume volume = noise(1);
  follower.offer(live);
  for (int i = 0; i < 100 && !follower.take(); ++i) {
    ++volume.metadata.index;
    follower.offer(volume);
    std::this_thread::sleep_for(1ms);
  }
}

} // namespace
} // namespace octascope::firmware_host
