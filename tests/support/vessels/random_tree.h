// A vessel tree drawn at random, for tests that need any tree at all.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "pipeline/vessels/tree.h"

namespace octascope::tests {

// About `segments` segments in a cube of some 20 mm: chains that branch, radii from 1 mm down to
// 5 µm, orders by radius, the three branches at the root.
inline pipeline::VesselTree random_tree(std::size_t segments, std::uint64_t seed) {
  pipeline::VesselTree tree;
  std::mt19937_64 random{seed};
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit{0, 1};
  const auto add = [&](std::array<float, 3> at, float radius, std::uint32_t parent,
                       pipeline::VesselBranch branch) {
    tree.positions_mm.push_back(at);
    tree.radii_mm.push_back(radius);
    tree.parents.push_back(parent);
    const float order = std::log2(radius / 0.005F) * 1.4F;
    tree.orders.push_back(static_cast<std::uint8_t>(std::fmin(std::fmax(order, 0.0F), 11.0F)));
    tree.branches.push_back(branch);
  };
  for (int i = 0; i < 3; ++i)
    add({static_cast<float>(i - 1), 0, 0}, 1, pipeline::no_parent,
        static_cast<pipeline::VesselBranch>(1 + i));
  while (tree.nodes() < segments + 3) {
    // Mostly the youngest third: long branches rather than stars.
    const float age = unit(random) * unit(random) * unit(random);
    const auto parent =
        static_cast<std::uint32_t>(static_cast<float>(tree.nodes() - 1) * (1 - age));
    const float thinner = 0.8F + 0.2F * unit(random);
    const float radius = std::fmax(0.005F, tree.radii_mm[parent] * thinner);
    const float length = 0.15F + 4 * radius * unit(random);
    std::array<float, 3> at = tree.positions_mm[parent];
    for (float& c : at)
      c += length * normal(random) - 0.02F * c;
    add(at, radius, parent, tree.branches[parent]);
  }
  return tree;
}

} // namespace octascope::tests
