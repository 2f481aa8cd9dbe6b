#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/vessel_orders.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/vessels/random_tree.h"

namespace octascope::pipeline {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

struct Node {
  std::uint32_t parent;
  float radius_mm;
};

VesselTree tree_of(const std::vector<Node>& nodes) {
  VesselTree tree;
  for (const Node& node : nodes) {
    tree.positions_mm.push_back({static_cast<float>(tree.nodes()), 0, 0});
    tree.radii_mm.push_back(node.radius_mm);
    tree.parents.push_back(node.parent);
    tree.branches.push_back(VesselBranch::unknown);
  }
  return tree;
}

// A full binary tree of so many levels, radius by level from the root (0).
template <class Radius> VesselTree full_tree(int levels, Radius radius) {
  std::vector<Node> nodes{{no_parent, radius(0)}, {0, radius(0)}};
  std::size_t first = 1;
  for (int level = 1; level < levels; ++level) {
    const std::size_t end = nodes.size();
    for (std::size_t parent = first; parent < end; ++parent) {
      for (int child = 0; child < 2; ++child)
        nodes.push_back({static_cast<std::uint32_t>(parent), radius(level)});
    }
    first = end;
  }
  return tree_of(nodes);
}

TEST(VesselOrders, are_strahlers_where_all_radii_are_equal) {
  // A trunk (1, 2) with two twigs on twigs (3, 4 on 2), one single twig (5) on 1.
  VesselTree tree = tree_of({{no_parent, 1}, {0, 1}, {1, 1}, {2, 1}, {2, 1}, {1, 1}});
  EXPECT_EQ(assign_vessel_orders(tree), OrderRule::strahler);
  EXPECT_THAT(tree.orders, ElementsAre(1, 1, 1, 0, 0, 0));
}

TEST(VesselOrders, beyond_eleven_are_counted_from_the_top) {
  VesselTree tree = full_tree(14, [](int) { return 1.0F; });
  EXPECT_EQ(assign_vessel_orders(tree), OrderRule::strahler);
  EXPECT_EQ(tree.orders[0], 11);
  EXPECT_EQ(tree.orders[1], 11);
  EXPECT_EQ(tree.orders[2], 10);
  EXPECT_EQ(std::ranges::count(tree.orders, 0), (1 << 13) + (1 << 12) + (1 << 11));
}

TEST(VesselOrders, are_the_levels_of_a_tree_whose_radii_halve) {
  VesselTree tree = full_tree(8, [](int level) { return 1.0F / static_cast<float>(1 << level); });
  EXPECT_EQ(assign_vessel_orders(tree), OrderRule::diameter);
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    ASSERT_FLOAT_EQ(tree.radii_mm[i], static_cast<float>(1 << tree.orders[i]) / 128) << i;
}

// What the paper corrects in Strahler's: a wide vessel that has but twigs is of a high order all
// along, and a narrow one that branches often does not rise.
TEST(VesselOrders, follow_the_diameter_and_not_the_branchings) {
  std::vector<Node> nodes{{no_parent, 1}};
  for (std::uint32_t i = 0; i < 40; ++i) // a trunk with a twig at every node, wide to its end
    nodes.push_back({i == 0 ? 0 : 2 * i - 1, 1.0F - 0.001F * static_cast<float>(i)}),
        nodes.push_back({2 * i + 1, 0.01F + 0.0001F * static_cast<float>(i)});
  const auto wide_end = static_cast<std::uint32_t>(nodes.size() - 2);
  nodes.push_back({wide_end, 0.995F}); // a tip by topology, the trunk's order by its diameter
  VesselTree tree = tree_of(nodes);
  EXPECT_EQ(assign_vessel_orders(tree), OrderRule::diameter);
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    ASSERT_EQ(tree.orders[i], tree.radii_mm[i] > 0.5F ? 1 : 0) << i;
}

// Classes drawn with the means and spreads of the paper's kind come out as they went in, whatever
// Strahler's orders say; all nodes of a vessel have one order.
TEST(VesselOrders, find_classes_of_diameters) {
  std::mt19937_64 random{tests::fresh_seed()};
  std::normal_distribution<float> spread{1, 0.08F};
  constexpr float radii_um[] = {4.8F, 9.5F, 19, 36, 70, 140};
  std::vector<Node> nodes{{no_parent, 0.14F}};
  std::vector<std::uint8_t> expected{5};
  std::vector<std::uint32_t> ends{0};
  std::vector<int> levels{6};
  for (std::size_t v = 0; v < ends.size() && nodes.size() < 60'000; ++v) {
    if (levels[v] == 0)
      continue;
    const int children = v == 0 ? 1 : 3;
    for (int c = 0; c < children; ++c) {
      // The first child of each goes on with the order below, others may skip some.
      const int level =
          c < 2 ? levels[v] - 1 : static_cast<int>(random() % static_cast<unsigned>(levels[v]));
      std::uint32_t parent = ends[v];
      const float radius = radii_um[level] / 1000 * spread(random);
      for (int i = 0; i < 3; ++i) { // three nodes a vessel, not quite alike
        nodes.push_back({parent, radius * (1 + 0.02F * static_cast<float>(i - 1))});
        expected.push_back(static_cast<std::uint8_t>(level));
        parent = static_cast<std::uint32_t>(nodes.size() - 1);
      }
      ends.push_back(parent);
      levels.push_back(level);
    }
  }
  VesselTree tree = tree_of(nodes);
  EXPECT_EQ(assign_vessel_orders(tree), OrderRule::diameter);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    wrong += tree.orders[i] != expected[i] ? 1U : 0U;
  EXPECT_LT(wrong, tree.nodes() / 100);
  for (std::size_t i = 1; i + 2 < tree.nodes(); i += 3)
    ASSERT_THAT((std::vector{tree.orders[i + 1], tree.orders[i + 2]}), Each(tree.orders[i]));
}

// Random radii, radii that grow towards the tips: orders without gaps from 0, wider never lower.
TEST(VesselOrders, make_sense_of_any_radii) {
  std::mt19937_64 random{tests::fresh_seed()};
  for (int round = 0; round < 30; ++round) {
    VesselTree tree = tests::random_tree(1 + random() % 3000, random());
    std::uniform_real_distribution<float> radius{0.001F, 2};
    for (std::size_t i = 0; i < tree.nodes(); ++i) {
      if (round % 3 == 1)
        tree.radii_mm[i] = radius(random);
      if (round % 3 == 2)
        tree.radii_mm[i] =
            tree.parents[i] == no_parent ? 0.01F : 1.01F * tree.radii_mm[tree.parents[i]];
    }
    assign_vessel_orders(tree);
    ASSERT_EQ(tree.orders.size(), tree.nodes());
    const auto highest = *std::ranges::max_element(tree.orders);
    ASSERT_LE(highest, highest_vessel_order);
    for (int order = 0; order <= highest; ++order)
      ASSERT_NE(std::ranges::count(tree.orders, order), 0) << "round " << round;
  }
}

TEST(VesselOrders, of_a_root_alone) {
  VesselTree tree = tree_of({{no_parent, 1}});
  EXPECT_EQ(assign_vessel_orders(tree), OrderRule::strahler);
  EXPECT_THAT(tree.orders, ElementsAre(0));
}

} // namespace
} // namespace octascope::pipeline
