#include "pipeline/vessels/clusters/cluster_facts.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "pipeline/vessels/clusters/tree_piece.h"

namespace octascope::pipeline {

std::uint64_t VesselFacts::segments_of(VesselBranch branch) const {
  std::uint64_t sum = 0;
  for (const std::uint64_t count : segments[static_cast<std::size_t>(branch)])
    sum += count;
  return sum;
}

std::uint64_t VesselFacts::segments_of(int order) const {
  std::uint64_t sum = 0;
  for (const auto& of_branch : segments)
    sum += of_branch[static_cast<std::size_t>(order)];
  return sum;
}

VesselFacts facts_of(const VesselTree& tree, const ClusterError& error, std::string provenance) {
  VesselFacts facts;
  facts.nodes = tree.nodes();
  facts.error = error;
  facts.provenance = std::move(provenance);
  TreeBox box;
  std::vector<std::uint8_t> children(tree.nodes(), 0); // two stand for more
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    box.include(tree.positions_mm[i]);
    const std::uint32_t parent = tree.parents[i];
    if (parent == no_parent) {
      ++facts.roots;
      continue;
    }
    children[parent] = static_cast<std::uint8_t>(std::min(children[parent] + 1, 2));
    facts.zero_lengths += tree.positions_mm[i] == tree.positions_mm[parent] ? 1U : 0U;
    ++facts.segments[static_cast<std::size_t>(tree.branches[i])][tree.orders[i]];
  }
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    facts.branch_points += children[i] == 2 ? 1U : 0U;
    facts.lone_roots += tree.parents[i] == no_parent && children[i] == 0 ? 1U : 0U;
  }
  if (facts.nodes > 0) {
    facts.lower_mm = box.lower;
    facts.upper_mm = box.upper;
  }
  return facts;
}

} // namespace octascope::pipeline
