// Coronary trees: exact numbers, the same bits whatever the threads, the published morphometry, all
// vessels in the heart's wall and all of the wall with vessels.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/coronary_tree/coronary_tree.h"
#include "sim/coronary_tree/hash_random.h"
#include "sim/coronary_tree/heart/heart_wall.h"
#include "sim/coronary_tree/heart/region.h"
#include "sim/coronary_tree/low_orders.h"
#include "sim/coronary_tree/morphometry_table.h"
#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

using pipeline::no_parent;
using pipeline::VesselBranch;
using pipeline::VesselTree;
using testing::HasSubstr;

#ifdef OCTASCOPE_SANITIZED
constexpr std::uint32_t large = 150'000;
constexpr std::uint32_t with_low_orders = large;
constexpr std::array<std::uint32_t, 2> sizes{1001, 60'000};
constexpr std::array<std::size_t, 1> thread_counts{3};
#else
constexpr std::uint32_t large = 400'000;
constexpr std::uint32_t with_low_orders = 1'000'000;
constexpr std::array<std::uint32_t, 5> sizes{1000, 1001, 4567, 60'000, 200'001};
constexpr std::array<std::size_t, 3> thread_counts{1, 2, 3};
#endif

CoronaryTree generate(std::uint32_t segments, std::uint64_t seed = 1, std::size_t threads = 2) {
  auto tree = generate_coronary_tree({segments, seed, threads});
  EXPECT_TRUE(tree) << tree.error().message;
  return std::move(*tree);
}

// Of all bits of a tree.
std::uint64_t hash_of(const VesselTree& tree) {
  std::uint64_t result = tree.nodes();
  const auto add = [&result](float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    result = hash(result, bits);
  };
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    for (const float c : tree.positions_mm[i])
      add(c);
    add(tree.radii_mm[i]);
    result =
        hash(result, tree.parents[i], tree.orders[i], static_cast<std::uint64_t>(tree.branches[i]));
  }
  return result;
}

Vector3 place_of(const VesselTree& tree, std::size_t node) {
  const auto& p = tree.positions_mm[node];
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

TEST(CoronaryTree, has_exactly_the_segments_asked_for) {
  for (const std::uint32_t segments : sizes) {
    const CoronaryTree coronary = generate(segments, segments);
    std::size_t roots = 0;
    for (const std::uint32_t parent : coronary.tree.parents)
      roots += parent == no_parent;
    EXPECT_EQ(roots, 3U);
    EXPECT_EQ(coronary.tree.nodes(), segments + 3);
  }
}

TEST(CoronaryTree, is_the_same_whatever_the_threads) {
  const std::uint64_t expected = hash_of(generate(100'000, 7, 1).tree);
  for (const std::size_t threads : thread_counts)
    EXPECT_EQ(hash_of(generate(100'000, 7, threads).tree), expected) << threads;
}

TEST(CoronaryTree, is_another_for_another_seed) {
  EXPECT_NE(hash_of(generate(1000, 1).tree), hash_of(generate(1000, 2).tree));
}

TEST(CoronaryTree, joins_parents_before_children_depth_first) {
  const VesselTree tree = generate(80'000).tree;
  for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
    if (tree.parents[i] == no_parent)
      continue;
    ASSERT_LT(tree.parents[i], i);
    // Depth first: the parent is the node before, or one of its ancestors.
    std::uint32_t at = i - 1;
    while (at != tree.parents[i]) {
      ASSERT_NE(tree.parents[at], no_parent) << i;
      at = tree.parents[at];
    }
    ASSERT_LE(tree.orders[i], tree.orders[tree.parents[i]]);
    ASSERT_EQ(tree.branches[i], tree.branches[tree.parents[i]]);
    ASSERT_GT(tree.radii_mm[i], 0.0F);
    ASSERT_LE(tree.radii_mm[i], tree.radii_mm[tree.parents[i]] * 1.0001F);
  }
}

TEST(CoronaryTree, keeps_the_large_vessels_when_cut_from_below) {
  const auto large_vessels = [](const VesselTree& tree) {
    std::vector<std::array<float, 3>> places;
    for (std::size_t i = 0; i < tree.nodes(); ++i)
      if (tree.orders[i] >= 9)
        places.push_back(tree.positions_mm[i]);
    return places;
  };
  const CoronaryTree small = generate(1000);
  EXPECT_EQ(small.lowest_order, 8U);
  EXPECT_EQ(large_vessels(small.tree), large_vessels(generate(70'000).tree));
}

TEST(CoronaryTree, follows_the_published_morphometry) {
  const CoronaryTree coronary = generate(with_low_orders);
  const MorphometryTable table = compare_with_published(coronary);
  for (std::size_t b = 0; b < 3; ++b)
    for (std::size_t order = coronary.lowest_order + 1; order < pipeline::vessel_order_count;
         ++order) {
      const OrderComparison& o = table.branches[b][order];
      if (!o.present)
        continue;
      // Where there are few elements, chance has its say.
      EXPECT_LT(std::abs(o.diameter_um.z), 0.2 + 2 / std::sqrt(o.elements.achieved))
          << b << ' ' << order;
      EXPECT_LT(std::abs(o.length_mm.z), 1.4) << b << ' ' << order;
      EXPECT_LT(std::abs(o.segments_per_element.z), 0.4) << b << ' ' << order;
      EXPECT_NEAR(o.elements.achieved / o.elements.published, 1, 0.2) << b << ' ' << order;
    }
  EXPECT_THAT(to_text(table), HasSubstr("RCA 11"));
}

TEST(CoronaryTree, declares_how_it_is_scaled) {
#ifdef OCTASCOPE_SANITIZED
  GTEST_SKIP() << "too slow with sanitizers";
#endif
  const CoronaryTree coronary = generate(6'500'000);
  const MorphometryTable table = compare_with_published(coronary);
  EXPECT_NEAR(table.whole_factor, 6.5 / 5.9, 0.02);
  EXPECT_GT(table.growth, 1.0);
  EXPECT_NEAR(compare_with_published(coronary.tree).growth, table.growth, 1e-3);
  for (std::size_t b = 0; b < 3; ++b)
    for (std::size_t order = 0; order < 5; ++order) {
      const OrderComparison& o = table.branches[b][order];
      EXPECT_NEAR(o.elements.achieved / (o.factor * o.elements.published), 1, 0.2)
          << b << ' ' << order;
    }
  // Kassab, Fung, Ann Biomed Eng 23 (1995): 1.03 and 1.05; more daughters an element make more.
  EXPECT_NEAR(table.murray_ratio, 1.04, 0.1);
}

// A file of vessels does not say how its tree was scaled.
TEST(CoronaryTree, shows_how_it_is_scaled) {
  for (const std::uint32_t segments : {sizes.front(), sizes.back()}) {
    const CoronaryTree made = generate(segments);
    const MorphometryTable declared = compare_with_published(made);
    const MorphometryTable shown = compare_with_published(made.tree);
    EXPECT_EQ(shown.growth, declared.growth) << segments;
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t order = made.lowest_order; order < pipeline::vessel_order_count; ++order) {
        const OrderComparison& o = shown.branches[b][order];
        EXPECT_EQ(o.segments, declared.branches[b][order].segments);
        if (o.present) {
          EXPECT_NEAR(o.factor / declared.branches[b][order].factor, 1, 0.25)
              << segments << ' ' << b << ' ' << order;
        }
      }
  }
}

// Elements of order 4 on a trunk, each with what `growth` gives it and nothing else.
TEST(LowOrders, are_found_where_there_are_more_than_published) {
  for (const double growth : {1.05, 1.2}) {
    LowOrders low;
    low.growth = growth;
    std::array<std::array<std::size_t, lowest_trunk_order>, 3> beginnings{};
    beginnings[1][4] = 1000;
    const double crown = crown_sizes(morphometry(coronary_branches[1]), low)[4];
    EXPECT_NEAR(fit_low_orders(beginnings, 1000 * crown).growth, growth, 1e-9);
  }
}

TEST(CoronaryTree, stays_in_the_wall) {
  const VesselTree tree = generate(large).tree;
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    const Vector3 p = place_of(tree, i);
    if (tree.orders[i] < 9) {
      ASSERT_LT(outside_muscle_mm(p), 0.05) << i;
    } else if (p.y < base_mm - 3) { // above, the arteries come from the aorta
      ASSERT_GT(depth_mm(p), -3) << i;
    }
  }
}

// Order by order the muscle is divided without a gap: wherever there is muscle, there are ends.
TEST(CoronaryTree, feeds_all_of_the_muscle) {
  constexpr double cube_mm = 5;
  constexpr std::size_t side = 24;
  const auto cube_of = [](Vector3 p) {
    const auto index = [](double c) { return static_cast<std::size_t>((c + 70) / cube_mm); };
    return (index(p.y) * 2 * side + index(p.z)) * 2 * side + index(p.x);
  };
  std::vector<int> muscle(4 * side * side * side * 2, 0);
  std::vector<int> ends(muscle.size(), 0);
  for (double x = -69.5; x < 50; ++x)
    for (double y = -69.5; y < 50; ++y)
      for (double z = -69.5; z < 50; ++z)
        muscle[cube_of({x, y, z})] += in_muscle({x, y, z});
  const VesselTree tree = generate(large).tree;
  std::vector<bool> is_end(tree.nodes(), true);
  for (const std::uint32_t parent : tree.parents)
    if (parent != no_parent)
      is_end[parent] = false;
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    if (is_end[i])
      ++ends[cube_of(place_of(tree, i))];
  int full = 0;
  int empty = 0;
  for (std::size_t i = 0; i < muscle.size(); ++i)
    if (muscle[i] == 125) {
      ++full;
      empty += ends[i] == 0;
    }
  EXPECT_GT(full, 200);
  EXPECT_LE(empty, full / 50);
}

TEST(CoronaryTree, refuses_what_it_cannot_make) {
  EXPECT_THAT(generate_coronary_tree({999, 1, 1}).error().message,
              HasSubstr("999 segments asked for, expected 1000 to 20000000"));
  EXPECT_FALSE(generate_coronary_tree({20'000'001, 1, 1}));
  EXPECT_THAT(generate_coronary_tree({1000, 1, 0}).error().message,
              HasSubstr("0 threads, expected 1 to 256"));
}

TEST(CoronaryTree, tells_how_far_it_is) {
  std::vector<double> told;
  ASSERT_TRUE(generate_coronary_tree({100'000, 1, 2}, [&](double done) { told.push_back(done); }));
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);
}

TEST(HashRandom, have_the_moments_they_promise) {
  HashRandom draws{3};
  for (const MeanAndDeviation wanted : {MeanAndDeviation{0.069, 0.046}, {1, 0.95}, {3.24, 2.09}}) {
    constexpr int count = 200'000;
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < count; ++i) {
      const double x = draws.positive(wanted);
      ASSERT_GE(x, 0);
      sum += x;
      squares += x * x;
    }
    const double mean = sum / count;
    EXPECT_NEAR(mean / wanted.mean, 1, 0.02);
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean) / wanted.deviation, 1, 0.04);
  }
}

TEST(Region, puts_the_lowest_first) {
  HashRandom draws{11};
  for (int round = 0; round < 200; ++round) {
    std::vector<Vector3> places(1 + draws.below(60));
    for (Vector3& p : places)
      p.x = std::floor(8 * draws.unit()); // many alike
    const std::size_t count = draws.below(places.size() + 1);
    lowest_first(places, count, [](const Vector3& p) { return p.x; });
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = count; k < places.size(); ++k)
        ASSERT_LE(places[i].x, places[k].x);
  }
}

} // namespace
} // namespace octascope::sim
