#include "pipeline/vessels/clusters/cluster_partition.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "pipeline/vessels/clusters/tree_cutter.h"
#include "pipeline/vessels/stoppable.h"

namespace octascope::pipeline {
namespace {

// The tree's nodes from the roots up, each subtree in one piece.
std::vector<std::uint32_t> depth_first(const VesselTree& tree, const std::stop_token& stop) {
  StopCheck stopped{stop};
  const std::size_t count = tree.nodes();
  std::vector<std::uint32_t> first_child(count, no_parent);
  std::vector<std::uint32_t> next_sibling(count, no_parent);
  std::vector<std::uint32_t> stack;
  for (std::size_t i = count; i-- > 0 && !stopped();) {
    const auto node = static_cast<std::uint32_t>(i);
    const std::uint32_t parent = tree.parents[i];
    if (parent == no_parent) {
      stack.push_back(node);
    } else {
      next_sibling[i] = first_child[parent];
      first_child[parent] = node;
    }
  }
  std::vector<std::uint32_t> order;
  order.reserve(count);
  while (!stack.empty() && !stopped()) {
    const std::uint32_t node = stack.back();
    stack.pop_back();
    order.push_back(node);
    for (std::uint32_t child = first_child[node]; child != no_parent; child = next_sibling[child])
      stack.push_back(child);
  }
  return order;
}

// Puts small pieces that lie side by side into one cluster.
class PieceGatherer {
public:
  explicit PieceGatherer(std::span<const TreePiece> pieces)
      : pieces_{pieces}, cluster_of_(pieces.size()) {}

  // By piece.
  std::vector<std::uint32_t> gather() {
    std::vector<Placed> small;
    TreeBox box;
    for (const TreePiece& piece : pieces_)
      box.include(piece.box);
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      const TreePiece& piece = pieces_[i];
      if (piece.segments >= large)
        cluster_of_[i] = clusters_++;
      else
        small.push_back({piece.kind, morton_code(box, piece.box.middle()), i});
    }
    std::ranges::sort(small, [](const Placed& a, const Placed& b) {
      return std::tie(a.kind, a.code, a.piece) < std::tie(b.kind, b.code, b.piece);
    });
    for (const Placed& placed : small)
      place(placed.piece);
    return std::move(cluster_of_);
  }

  std::uint32_t clusters() const { return clusters_; }

private:
  static constexpr std::uint32_t large = 200; // segments: hardly anything more would fit
  static constexpr std::uint32_t poor = 100;  // segments: rather a wide box than that few

  struct Placed {
    std::uint32_t kind;
    std::uint64_t code;
    std::uint32_t piece;
  };

  // A cluster with room left.
  struct Place {
    TreePiece content;
    std::uint32_t references = 0; // at most
    std::uint32_t cluster = 0;
  };

  static std::uint32_t references_more(const Place& place, const TreePiece& piece) {
    return piece.parent == place.content.parent ? 0 : 2;
  }

  // The longest side of what the box would be; infinite where the piece does not belong.
  static float side_with(const Place& place, const TreePiece& piece) {
    constexpr float never = std::numeric_limits<float>::infinity();
    const TreePiece& content = place.content;
    if (content.segments == 0 || content.kind != piece.kind ||
        content.segments + piece.segments + place.references + references_more(place, piece) >
            largest_cluster)
      return never;
    TreePiece both = content;
    both.join(piece);
    const float side = both.box.longest_side();
    const bool compact = side <= 2 * std::max(content.box.longest_side(), piece.box.longest_side());
    return both.fine_enough() && (compact || both.segments < poor) ? side : never;
  }

  void place(std::uint32_t number) {
    const TreePiece& piece = pieces_[number];
    Place* best = nullptr;
    float best_side = std::numeric_limits<float>::infinity();
    for (Place& place : open_)
      if (const float side = side_with(place, piece); side < best_side) {
        best = &place;
        best_side = side;
      }
    if (best == nullptr) {
      best = &open_[oldest_++ % open_.size()];
      *best = {};
      best->content.kind = piece.kind;
      best->cluster = clusters_++;
    }
    best->references += references_more(*best, piece);
    best->content.join(piece);
    best->content.parent = piece.parent;
    cluster_of_[number] = best->cluster;
  }

  std::span<const TreePiece> pieces_;
  std::vector<std::uint32_t> cluster_of_;
  std::uint32_t clusters_ = 0;
  std::array<Place, 8> open_;
  std::size_t oldest_ = 0;
};

} // namespace

ClusterPartition partition_tree(const VesselTree& tree, const std::stop_token& stop) {
  const std::vector<std::uint32_t> order = depth_first(tree, stop);
  if (stop.stop_requested())
    return {};
  const TreePieces cut = cut_tree(tree, order, stop);
  if (stop.stop_requested())
    return {};
  PieceGatherer gatherer{cut.pieces};
  std::vector<std::uint32_t> cluster_of = gatherer.gather();

  // Clusters are counted anew, in the order in which the walk through the tree comes to them.
  std::vector<std::uint32_t> numbers(gatherer.clusters(), no_parent);
  std::vector<std::uint32_t> sizes;
  const auto number_of = [&](std::uint32_t node) -> std::uint32_t& {
    return numbers[cluster_of[cut.piece_of[node]]];
  };
  StopCheck stopped{stop};
  for (const std::uint32_t node : order) {
    if (stopped())
      return {};
    if (tree.parents[node] == no_parent)
      continue;
    std::uint32_t& number = number_of(node);
    if (number == no_parent) {
      number = static_cast<std::uint32_t>(sizes.size());
      sizes.push_back(0);
    }
    ++sizes[number];
  }
  ClusterPartition partition;
  partition.ends = std::move(sizes);
  std::uint32_t total = 0;
  for (std::uint32_t& end : partition.ends) // so far its beginning: the segments below move it
    total += std::exchange(end, total);
  partition.segments.assign(total, no_parent);
  for (const std::uint32_t node : order) {
    if (stopped())
      return {};
    if (tree.parents[node] != no_parent)
      partition.segments[partition.ends[number_of(node)]++] = node;
  }
  return partition;
}

} // namespace octascope::pipeline
