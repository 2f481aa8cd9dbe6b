// Vessel trees of extreme shapes, for tests of what has to cope with any.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "pipeline/vessels/tree.h"

namespace octascope::tests {

// Adds nodes to a tree, at random directions from their parents.
class TreeGrower {
public:
  explicit TreeGrower(std::uint64_t seed) : random_{seed} {}

  std::uint32_t root(float radius) {
    return push({0, 0, 0}, radius, pipeline::no_parent, 0, pipeline::VesselBranch::lad);
  }

  std::uint32_t grow(std::uint32_t parent, float length, float radius, int order) {
    std::array<float, 3> way{};
    for (float& c : way)
      c = normal_(random_);
    const float norm = std::hypot(way[0], way[1], way[2]);
    std::array<float, 3> at = tree.positions_mm[parent];
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] += length * way[axis] / norm;
    return push(at, radius, parent, order, tree.branches[parent]);
  }

  float unit() { return unit_(random_); }

  pipeline::VesselTree tree;

private:
  std::uint32_t push(std::array<float, 3> at, float radius, std::uint32_t parent, int order,
                     pipeline::VesselBranch branch) {
    tree.positions_mm.push_back(at);
    tree.radii_mm.push_back(radius);
    tree.parents.push_back(parent);
    tree.orders.push_back(static_cast<std::uint8_t>(order));
    tree.branches.push_back(branch);
    return static_cast<std::uint32_t>(tree.nodes() - 1);
  }

  std::mt19937_64 random_;
  std::normal_distribution<float> normal_;
  std::uniform_real_distribution<float> unit_{0, 1};
};

// One vessel without a branch.
inline pipeline::VesselTree chain_tree(std::size_t segments, std::uint64_t seed) {
  TreeGrower grower{seed};
  std::uint32_t end = grower.root(0.01F);
  for (std::size_t i = 0; i < segments; ++i)
    end = grower.grow(end, 0.05F, 0.01F, 2);
  return std::move(grower.tree);
}

// All from one node.
inline pipeline::VesselTree star_tree(std::size_t segments, std::uint64_t seed) {
  TreeGrower grower{seed};
  const std::uint32_t middle = grower.grow(grower.root(1), 1, 1, 5);
  for (std::size_t i = 1; i < segments; ++i)
    grower.grow(middle, 5 * grower.unit(), 0.02F, 3);
  return std::move(grower.tree);
}

// A trunk with a twig at every node.
inline pipeline::VesselTree caterpillar_tree(std::size_t segments, std::uint64_t seed) {
  TreeGrower grower{seed};
  std::uint32_t trunk = grower.root(0.1F);
  while (grower.tree.nodes() <= segments) {
    trunk = grower.grow(trunk, 0.3F, 0.1F, 5);
    if (grower.tree.nodes() <= segments)
      grower.grow(trunk, 0.1F, 0.01F, 1);
  }
  return std::move(grower.tree);
}

// Two from each node, level by level: neighbours are far apart in the arrays.
inline pipeline::VesselTree binary_tree(std::size_t segments, std::uint64_t seed) {
  TreeGrower grower{seed};
  grower.root(1);
  std::vector<float> lengths{4};
  for (std::uint32_t parent = 0; grower.tree.nodes() <= segments; ++parent)
    for (int i = 0; i < 2 && grower.tree.nodes() <= segments; ++i) {
      lengths.push_back(lengths[parent] * 0.8F);
      const float radius = grower.tree.radii_mm[parent] * 0.79F;
      const int order = std::clamp(static_cast<int>(11 + 1.5F * std::log2(radius)), 0, 11);
      grower.grow(parent, lengths.back(), std::max(radius, 0.004F), order);
    }
  return std::move(grower.tree);
}

// Like an arterial tree: a vessel of an order has a few segments, and at the end of each one or two
// vessels of the next orders leave. Lengths, diameters and counts are about those of coronary
// arteries (Kassab et al. 1993); stops at so many segments.
inline pipeline::VesselTree fractal_tree(std::size_t segments, std::uint64_t seed) {
  constexpr std::array<float, 12> lengths{0.05F, 0.06F, 0.08F, 0.08F, 0.12F, 0.45F,
                                          0.7F,  1.0F,  1.3F,  1.8F,  2.0F,  3.0F};
  constexpr std::array<float, 12> radii{0.0032F, 0.0047F, 0.0065F, 0.0095F, 0.017F, 0.035F,
                                        0.07F,   0.14F,   0.23F,   0.4F,    0.8F,   1.6F};
  TreeGrower grower{seed};
  struct Bud {
    std::uint32_t parent;
    int order;
  };
  std::vector<Bud> buds{{grower.root(1.6F), 11}};
  while (!buds.empty() && grower.tree.nodes() <= segments) {
    const Bud bud = buds.back();
    buds.pop_back();
    const auto order = static_cast<std::size_t>(bud.order);
    const int count = bud.order > 7 ? 8 : bud.order > 0 ? 2 : 1;
    std::uint32_t end = bud.parent;
    for (int i = 0; i < count; ++i) {
      end = grower.grow(end, lengths[order] * (0.5F + grower.unit()), radii[order], bud.order);
      if (bud.order == 0)
        continue;
      const int down = grower.unit() < 0.8F ? 1 : 1 + static_cast<int>(grower.unit() * 4);
      buds.push_back({end, std::max(bud.order - down, 0)});
    }
    if (bud.order > 0)
      buds.push_back({end, bud.order - 1});
  }
  return std::move(grower.tree);
}

// Everything at once: each of these has stopped a reader somewhere.
inline pipeline::VesselTree degenerate_tree(std::size_t segments, std::uint64_t seed) {
  TreeGrower grower{seed};
  for (std::uint32_t parent = grower.root(0); grower.tree.nodes() <= segments;) {
    const float kind = grower.unit();
    if (kind < 0.01F)
      parent = grower.root(0.5F);
    const float length = kind < 0.3F ? 0 : kind < 0.99F ? 0.1F : 200.0F;
    const float radius = kind < 0.5F ? 0 : kind < 0.98F ? 0.01F : 50.0F;
    const std::uint32_t child =
        grower.grow(parent, length, radius, static_cast<int>(grower.unit() * 12));
    grower.tree.branches.back() = static_cast<pipeline::VesselBranch>(grower.unit() * 4);
    parent =
        kind < 0.6F ? child : static_cast<std::uint32_t>(grower.unit() * static_cast<float>(child));
  }
  return std::move(grower.tree);
}

// All in one place, all the same.
inline pipeline::VesselTree point_tree(std::size_t segments, std::uint64_t seed) {
  TreeGrower grower{seed};
  grower.root(0.1F);
  for (std::size_t i = 0; i < segments; ++i)
    grower.grow(static_cast<std::uint32_t>(grower.unit() * static_cast<float>(i)), 0, 0.1F, 3);
  return std::move(grower.tree);
}

struct NamedTree {
  const char* name;
  pipeline::VesselTree tree;
};

inline std::vector<NamedTree> trees_of_all_shapes(std::size_t segments, std::uint64_t seed) {
  std::vector<NamedTree> trees;
  trees.push_back({"fractal", fractal_tree(segments, seed)});
  trees.push_back({"chain", chain_tree(segments, seed)});
  trees.push_back({"star", star_tree(segments, seed)});
  trees.push_back({"caterpillar", caterpillar_tree(segments, seed)});
  trees.push_back({"binary", binary_tree(segments, seed)});
  trees.push_back({"degenerate", degenerate_tree(segments, seed)});
  trees.push_back({"point", point_tree(segments, seed)});
  return trees;
}

} // namespace octascope::tests
