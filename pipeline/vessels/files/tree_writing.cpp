#include "pipeline/vessels/files/tree_writing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/vessels/files/tree_reading.h"

namespace octascope::pipeline {

namespace {

bool is_length(float value) {
  return std::fabs(value) <= largest_vessel_length_mm; // false for NaN
}

} // namespace

hal::Result<> check_tree_to_write(const std::filesystem::path& file, const VesselTree& tree,
                                  std::uint64_t most_nodes) {
  const auto refuse = [&](std::string_view found, std::string_view expected) {
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "{}: cannot be written: found {}, expected {}", file.string(), found,
                     expected);
  };
  const std::size_t nodes = tree.nodes();
  if (nodes == 0 || nodes > most_nodes)
    return refuse(fmt::format("{} nodes", nodes), fmt::format("1 to {}", most_nodes));
  if (tree.radii_mm.size() != nodes || tree.parents.size() != nodes ||
      tree.orders.size() != nodes || tree.branches.size() != nodes)
    return refuse("properties of different lengths", fmt::format("{} of each", nodes));
  for (std::size_t i = 0; i < nodes; ++i) {
    if (tree.parents[i] != no_parent && tree.parents[i] >= i)
      return refuse(fmt::format("node {} with the parent {}", i, tree.parents[i]),
                    "parents in front of their children");
    if (!std::ranges::all_of(tree.positions_mm[i], is_length) || !is_length(tree.radii_mm[i]) ||
        tree.radii_mm[i] < 0)
      return refuse(fmt::format("node {} with a place or radius that is no length", i),
                    "finite numbers, radii of 0 or more");
    if (tree.orders[i] > highest_vessel_order)
      return refuse(fmt::format("node {} of order {}", i, tree.orders[i]),
                    fmt::format("0 to {}", highest_vessel_order));
  }
  return {};
}

} // namespace octascope::pipeline
