// What every tree keeps that a reader gives.
#pragma once

#include <cmath>

#include "pipeline/vessels/tree.h"
#include "tests/fuzz/expect.h"

namespace octascope::tests {

inline void expect_tree(const pipeline::VesselTree& tree) {
  expect(tree.nodes() > 0, "a tree has nodes");
  expect(tree.parents.size() == tree.nodes() && tree.radii_mm.size() == tree.nodes(),
         "every node has a radius and a parent");
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    expect(tree.parents[i] == pipeline::no_parent || tree.parents[i] < i, "parents come first");
    expect(tree.radii_mm[i] > 0 && tree.radii_mm[i] <= pipeline::largest_vessel_length_mm,
           "radii are positive and bounded");
    for (const float mm : tree.positions_mm[i])
      expect(std::fabs(mm) <= pipeline::largest_vessel_length_mm, "places are finite and bounded");
  }
}

} // namespace octascope::tests
