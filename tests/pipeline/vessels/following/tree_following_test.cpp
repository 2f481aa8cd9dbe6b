// A known tree over trees that are traced now and then, and volumes that move in between.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/following/tree_following.h"
#include "pipeline/vessels/vectors.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

const VolumeGeometry small_field{.depths = 130,
                                 .a_scans = 96,
                                 .b_scans = 64,
                                 .depth_spacing_um = 10,
                                 .a_spacing_um = 25,
                                 .b_spacing_um = 37.5};

class TreeFollowingTest : public testing::Test {
protected:
  double number(double low, double high) {
    return std::uniform_real_distribution{low, high}(random_);
  }

  // 14 vessels that bend, in 2.4 × 2.4 × 1.1 mm.
  VesselTree bed() {
    VesselTree tree;
    for (int i = 0; i < 14; ++i) {
      Point at{number(0.4, 2), number(0.4, 2), number(0.2, 1)};
      Point along = direction(Point{number(-1, 1), number(-1, 1), number(-0.3, 0.3)});
      for (int j = 0; j < 26; ++j) {
        tree.positions_mm.push_back(
            {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])});
        tree.radii_mm.push_back(0.02F);
        tree.parents.push_back(j == 0 ? no_parent : static_cast<std::uint32_t>(tree.nodes() - 2));
        tree.orders.push_back(0);
        tree.branches.push_back(VesselBranch::unknown);
        along = direction(sum(along, {number(-0.2, 0.2), number(-0.2, 0.2), number(-0.1, 0.1)}));
        at = sum(at, scaled(along, 0.05));
      }
    }
    return tree;
  }

  static VesselTree shifted(VesselTree tree, const Point& by_mm) {
    for (auto& at : tree.positions_mm)
      for (std::size_t axis = 0; axis < 3; ++axis)
        at[axis] += static_cast<float>(by_mm[axis]);
    return tree;
  }

  // Balls, the same for a seed, shifted.
  static Volume volume(unsigned seed, const Point& by_mm) {
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> unit;
    Volume made{small_field};
    std::ranges::fill(made.b_scan_states, BScanState::good);
    std::vector<float> sums(small_field.voxels());
    for (int i = 0; i < 900; ++i) {
      const Point at{unit(random) * 3.4 - 0.5 + by_mm[0], unit(random) * 3.4 - 0.5 + by_mm[1],
                     unit(random) * 1.7 - 0.2 + by_mm[2]};
      const auto middle = [&](std::size_t axis, double spacing_um) {
        return static_cast<int>(std::floor(at[axis] * 1e3 / spacing_um));
      };
      const int a = middle(0, 25), b = middle(1, 37.5), z = middle(2, 10);
      for (int bb = std::max(b - 3, 0); bb < std::min(b + 4, 64); ++bb)
        for (int aa = std::max(a - 4, 0); aa < std::min(a + 5, 96); ++aa)
          for (int zz = std::max(z - 8, 0); zz < std::min(z + 9, 130); ++zz) {
            const Point off =
                difference(at, {(aa + 0.5) * 0.025, (bb + 0.5) * 0.0375, (zz + 0.5) * 0.01});
            sums[static_cast<std::size_t>((bb * 96 + aa) * 130 + zz)] +=
                static_cast<float>(60 * std::exp(-product(off, off) / 0.0015));
          }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
      made.levels[i] = static_cast<std::uint8_t>(std::min(sums[i], 255.0F));
    return made;
  }

  void see(TreeFollowing& following, unsigned seed, const Point& by_mm) {
    const Volume next = volume(seed, by_mm);
    following.add_volume(next.geometry, next.levels, next.b_scan_states, ++index_);
  }

  static double off_mm(const TreeFollowing& following, const Point& shift_mm) {
    return following.place().volume_from_tree
               ? length(difference(following.place().volume_from_tree->apply({1, 1, 0.5}),
                                   sum({1, 1, 0.5}, shift_mm)))
               : 1e9;
  }

  std::mt19937 random_{tests::fresh_seed()};
  std::uint64_t index_ = 0;
};

TEST_F(TreeFollowingTest, moves_a_tree_with_the_volumes_from_where_it_was_registered) {
  const VesselTree tree = bed();
  TreeFollowing following{tree, {}};
  see(following, 1, {});
  EXPECT_FALSE(following.place().volume_from_tree) << "at a guessed place";
  const std::uint64_t traced_in = index_;
  see(following, 1, {0.05, 0, 0}); // while the tree was being traced
  following.add_tree(shifted(tree, {0.3, -0.2, 0.1}), traced_in);
  EXPECT_LT(off_mm(following, {0.35, -0.2, 0.1}), 0.02);
  EXPECT_GT(following.place().overlap, 0.9);
  see(following, 1, {0.1, -0.08, 0.05});
  EXPECT_LT(off_mm(following, {0.4, -0.28, 0.15}), 0.02);
  // A tree traced now is 60 µm from there: tissue that has turned, say. It counts.
  following.add_tree(shifted(tree, {0.4, -0.22, 0.15}), index_);
  EXPECT_LT(off_mm(following, {0.4, -0.22, 0.15}), 0.01);
}

TEST_F(TreeFollowingTest, gives_up_what_no_longer_matches) {
  const VesselTree tree = bed();
  TreeFollowing following{tree, {}};
  see(following, 1, {});
  following.add_tree(tree, index_);
  ASSERT_LT(off_mm(following, {}), 0.01);
  const VesselTree other = bed();
  for (int i = 1; i < TreeFollowing::most_misses; ++i) {
    following.add_tree(other, index_);
    EXPECT_LT(off_mm(following, {}), 0.01);
    EXPECT_THAT(following.place().refusal, HasSubstr("of the vessels that are seen"));
  }
  following.add_tree(other, index_);
  EXPECT_FALSE(following.place().volume_from_tree);
  EXPECT_THAT(following.place().refusal, HasSubstr("of the vessels that are seen"));
  // And finds it again, some trees later.
  for (int i = 0; i < TreeFollowing::trees_between_searches; ++i) {
    following.add_tree(tree, index_);
    EXPECT_FALSE(following.place().volume_from_tree);
  }
  following.add_tree(tree, index_);
  EXPECT_LT(off_mm(following, {}), 0.01);
  EXPECT_EQ(following.place().refusal, "");
}

TEST_F(TreeFollowingTest, loses_a_tree_with_a_volume_of_another_place) {
  const VesselTree tree = bed();
  TreeFollowing following{tree, {}};
  see(following, 1, {});
  following.add_tree(tree, index_);
  ASSERT_LT(off_mm(following, {}), 0.01);
  see(following, 2, {});
  EXPECT_FALSE(following.place().volume_from_tree);
  EXPECT_THAT(following.place().refusal, HasSubstr("of another place"));
}

TEST_F(TreeFollowingTest, leaves_out_a_tree_of_a_volume_that_it_has_not_seen) {
  const VesselTree tree = bed();
  TreeFollowing following{tree, {}};
  following.add_tree(tree, index_);
  EXPECT_FALSE(following.place().volume_from_tree);
  index_ = 5;
  see(following, 1, {});
  following.add_tree(tree, index_ - 1); // what has moved since?
  EXPECT_FALSE(following.place().volume_from_tree);
  following.add_tree(tree, index_);
  EXPECT_LT(off_mm(following, {}), 0.01);
}

TEST_F(TreeFollowingTest, begins_where_it_is_told) {
  const VesselTree tree = bed();
  RigidTransform far;
  far.shift_mm = {10, 5, -3};
  TreeFollowing following{shifted(tree, {-10, -5, 3}), far};
  see(following, 1, {});
  EXPECT_FALSE(following.place().volume_from_tree);
  following.add_tree(shifted(tree, {0.1, 0.1, 0}), index_);
  ASSERT_TRUE(following.place().volume_from_tree);
  const Point at = following.place().volume_from_tree->apply({-9, -4, 3.5});
  EXPECT_LT(length(difference(at, {1.1, 1.1, 0.5})), 0.01);
}

} // namespace
} // namespace octascope::pipeline
