#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/clusters/cluster_unpacker.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/vessels/random_tree.h"
#include "tests/support/vessels/same_tree.h"
#include "tests/support/vessels/vessel_trees.h"

namespace octascope::pipeline {
namespace {

double bytes_a_segment(const ClusterArrays& arrays) {
  return static_cast<double>(arrays.clusters.size() * sizeof(VesselCluster) +
                             arrays.nodes.size() * sizeof(PackedNode) +
                             arrays.sources.size() * sizeof(std::uint32_t)) /
         static_cast<double>(arrays.segments);
}

float longest_side(const VesselCluster& cluster) {
  return static_cast<float>(vessel_place_steps) *
         std::max({cluster.step_mm[0], cluster.step_mm[1], cluster.step_mm[2]});
}

// What clusters.h promises of each cluster.
void expect_promises(const ClusterArrays& arrays) {
  std::uint32_t next = 0;
  std::size_t next_source = 0;
  for (const VesselCluster& cluster : arrays.clusters) {
    ASSERT_EQ(cluster.first_node, next);
    ASSERT_GT(cluster.segments(), 0U);
    const auto node = [&](std::uint32_t i) { return arrays.nodes[cluster.first_node + i]; };
    float thickest = 0;
    double length_mm = 0;
    for (std::uint32_t i = 0; i < cluster.nodes; ++i) {
      ASSERT_EQ(node(i).is_reference(), i < cluster.references);
      ASSERT_LT(node(i).parent(), cluster.nodes);
      if (i < cluster.references)
        continue;
      ASSERT_NE(node(i).parent(), i);
      ASSERT_LE(i == cluster.references ? 0 : node(i).order(),
                i == cluster.references ? 0 : node(i - 1).order());
      const std::uint32_t parent = node(i).parent();
      // The parent's parent is here, too, unless the parent is a root.
      if (node(parent).parent() == parent) {
        const std::uint32_t source = arrays.sources[next_source + parent];
        ASSERT_TRUE(arrays.nodes[source].is_reference());
      }
      const float radius = unpack(cluster, node(i)).radius_mm;
      const auto& a = unpack(cluster, node(i)).position_mm;
      const auto& b = unpack(cluster, node(parent)).position_mm;
      length_mm += std::hypot<double>(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
      thickest = std::max({thickest, radius,
                           segment_start_radius(unpack(cluster, node(parent)).radius_mm, radius)});
    }
    ASSERT_FLOAT_EQ(cluster.largest_radius_mm, thickest);
    ASSERT_NEAR(cluster.length_mm, length_mm,
                2e-3 * double{arrays.error.position_um} * cluster.segments() + 1e-5 * length_mm);
    for (unsigned order = 0; order < vessel_order_count; ++order) {
      std::uint32_t count = cluster.references;
      for (std::uint32_t i = cluster.references; i < cluster.nodes; ++i)
        count += node(i).order() >= order ? 1U : 0U;
      ASSERT_EQ(cluster.nodes_from_order[order], count);
    }
    next += cluster.nodes;
    next_source += cluster.references;
  }
  EXPECT_EQ(next, arrays.nodes.size());
  EXPECT_EQ(next_source, arrays.sources.size());
}

TEST(ClusterBuilder, keeps_its_promises_on_trees_of_all_shapes) {
  for (const auto& [name, tree] : tests::trees_of_all_shapes(6000, tests::fresh_seed())) {
    SCOPED_TRACE(name);
    const ClusterArrays arrays = build_clusters(tree);
    EXPECT_EQ(arrays.segments,
              static_cast<std::size_t>(std::ranges::count_if(
                  tree.parents, [](std::uint32_t parent) { return parent != no_parent; })));
    expect_promises(arrays);
  }
}

TEST(ClusterBuilder, unpacks_to_the_same_tree_within_the_stated_error) {
  for (const auto& [name, tree] : tests::trees_of_all_shapes(3000, tests::fresh_seed())) {
    if (std::string_view{name} == "point") // all pairings are right there
      continue;
    SCOPED_TRACE(name);
    const ClusterArrays arrays = build_clusters(tree);
    const auto unpacked = unpack_tree(arrays.view());
    ASSERT_TRUE(unpacked) << unpacked.error().message;
    for (std::uint32_t i = 0; i < unpacked->nodes(); ++i)
      ASSERT_TRUE(unpacked->parents[i] < i || unpacked->parents[i] == no_parent);
    if (std::string_view{name} == "degenerate") // nodes that are alike can be paired either way
      continue;
    tests::TreeComparison comparison{tree, *unpacked};
    ASSERT_EQ(comparison.run(), "");
    EXPECT_GT(arrays.error.position_um, 0);
    // The stated error holds for references, too, so that it may be a little more.
    EXPECT_LE(comparison.error().position_um, 1.001F * arrays.error.position_um);
    EXPECT_GE(comparison.error().position_um, 0.7F * arrays.error.position_um);
    EXPECT_LE(comparison.error().relative_radius, arrays.error.relative_radius + 1e-6F);
    EXPECT_GE(comparison.error().relative_radius, 0.7F * arrays.error.relative_radius - 1e-6F);
  }
}

TEST(ClusterBuilder, takes_no_more_than_nine_bytes_a_segment) {
  for (const auto& [name, tree] : tests::trees_of_all_shapes(100000, 3)) {
    if (std::string_view{name} == "degenerate") // branches and orders drawn by lot
      continue;
    const ClusterArrays arrays = build_clusters(tree);
    fmt::print("  {:12} {:.2f} bytes a segment, {:.0f} segments a cluster\n", name,
               bytes_a_segment(arrays),
               static_cast<double>(arrays.segments) / static_cast<double>(arrays.clusters.size()));
    EXPECT_LE(bytes_a_segment(arrays), 9) << name;
  }
  EXPECT_LE(bytes_a_segment(build_clusters(tests::random_tree(100000, 3))), 9);
}

TEST(ClusterBuilder, errs_by_a_tenth_of_the_thinnest_radius_at_most) {
  const ClusterArrays arrays = build_clusters(tests::fractal_tree(100000, 4));
  for (const VesselCluster& cluster : arrays.clusters) {
    float thinnest = std::numeric_limits<float>::max();
    for (std::uint32_t i = cluster.references; i < cluster.nodes; ++i)
      thinnest =
          std::min(thinnest, unpack(cluster, arrays.nodes[cluster.first_node + i]).radius_mm);
    const auto& s = cluster.step_mm;
    if (cluster.segments() > 1) {
      ASSERT_LE(std::hypot(s[0], s[1], s[2]) / 2, 0.101F * thinnest);
    }
  }
}

TEST(ClusterBuilder, keeps_thick_and_thin_vessels_apart_and_boxes_small) {
  const ClusterArrays arrays = build_clusters(tests::fractal_tree(100000, 5));
  std::vector<float> sides;
  for (const VesselCluster& cluster : arrays.clusters) {
    sides.push_back(longest_side(cluster));
    // Orders 5 and more are half a millimetre long and more, capillaries a twentieth.
    if (cluster.nodes_from_order[6] > cluster.references) {
      EXPECT_EQ(cluster.nodes_from_order[2], cluster.nodes);
    }
  }
  std::ranges::sort(sides);
  // 250 capillaries in a row, coiled at random, measure about a millimetre.
  EXPECT_LT(sides[sides.size() / 2], 1);
  EXPECT_LT(sides[sides.size() * 98 / 100], 3);
}

TEST(ClusterBuilder, puts_neighbours_side_by_side) {
  const ClusterArrays arrays = build_clusters(tests::binary_tree(100000, 6));
  const auto distance = [&](std::size_t a, std::size_t b) {
    const auto& p = arrays.clusters[a].origin_mm;
    const auto& q = arrays.clusters[b].origin_mm;
    return std::hypot<double>(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  };
  double neighbours = 0;
  double strangers = 0;
  const std::size_t count = arrays.clusters.size();
  for (std::size_t i = 0; i + 1 < count; ++i) {
    neighbours += distance(i, i + 1);
    strangers += distance(i, i * 7919 % count);
  }
  EXPECT_LT(neighbours, 0.25 * strangers);
}

TEST(ClusterBuilder, draws_lots_within_an_order) {
  // Of a chain's segments the first half of each cluster must not be one end of the chain.
  const ClusterArrays arrays = build_clusters(tests::chain_tree(2000, 7));
  for (const VesselCluster& cluster : arrays.clusters) {
    if (cluster.segments() < 100)
      continue;
    std::size_t children_in_first_half = 0;
    const std::uint32_t half = cluster.references + cluster.segments() / 2;
    for (std::uint32_t i = cluster.references; i < half; ++i)
      children_in_first_half += arrays.nodes[cluster.first_node + i].parent() < half ? 1U : 0U;
    EXPECT_LT(children_in_first_half, 0.75 * cluster.segments() / 2);
  }
}

TEST(ClusterBuilder, makes_the_same_bytes_each_time) {
  const VesselTree tree = tests::degenerate_tree(5000, 8);
  const ClusterArrays a = build_clusters(tree);
  const ClusterArrays b = build_clusters(tree);
  ASSERT_EQ(a.clusters.size(), b.clusters.size());
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  EXPECT_EQ(std::memcmp(a.clusters.data(), b.clusters.data(), a.clusters.size() * 64), 0);
  EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * 8), 0);
  EXPECT_EQ(a.sources, b.sources);
}

TEST(ClusterBuilder, copes_with_hardly_a_tree) {
  VesselTree tree;
  EXPECT_EQ(build_clusters(tree).clusters.size(), 0U);
  tests::TreeGrower grower{9};
  grower.root(1);
  EXPECT_EQ(build_clusters(grower.tree).clusters.size(), 0U);
  grower.root(1);
  grower.grow(1, 2, 1, 3);
  const ClusterArrays arrays = build_clusters(grower.tree);
  ASSERT_EQ(arrays.clusters.size(), 1U);
  EXPECT_EQ(arrays.clusters[0].segments(), 1U);
  EXPECT_EQ(arrays.clusters[0].references, 1);
  expect_promises(arrays);
}

TEST(ClusterBuilder, keeps_a_radius_of_nothing_as_a_nanometre) {
  tests::TreeGrower grower{10};
  grower.grow(grower.root(0), 1, 0, 0);
  const ClusterArrays arrays = build_clusters(grower.tree);
  EXPECT_FLOAT_EQ(unpack(arrays.clusters[0], arrays.nodes[1]).radius_mm, thinnest_vessel_mm);
  EXPECT_EQ(arrays.error.relative_radius, 0);
}

TEST(ClusterBuilder, keeps_every_segment_and_its_length) {
  const VesselTree tree = tests::random_tree(20000, 1);
  const ClusterArrays arrays = build_clusters(tree);
  EXPECT_EQ(arrays.segments, 20000U);
  double expected = 0;
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    if (tree.parents[i] != no_parent) {
      const auto& a = tree.positions_mm[i];
      const auto& b = tree.positions_mm[tree.parents[i]];
      expected += std::hypot<double>(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    }
  double found = 0;
  double stated = 0;
  for (const VesselCluster& cluster : arrays.clusters) {
    stated += double{cluster.length_mm};
    for (std::uint32_t i = cluster.references; i < cluster.nodes; ++i) {
      const PackedNode node = arrays.nodes[cluster.first_node + i];
      const VesselNode end = unpack(cluster, node);
      const VesselNode start = unpack(cluster, arrays.nodes[cluster.first_node + node.parent()]);
      const auto& a = end.position_mm;
      const auto& b = start.position_mm;
      found += std::hypot<double>(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    }
  }
  EXPECT_NEAR(found, expected, 1e-3 * expected);
  EXPECT_NEAR(stated, expected, 1e-5 * expected);
}

} // namespace
} // namespace octascope::pipeline
