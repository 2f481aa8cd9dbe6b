#include "pipeline/vessels/clusters/cluster_packer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace octascope::pipeline {
namespace {

// A number that looks drawn by lot and is the same in every run.
std::uint32_t lot(std::uint32_t node) {
  std::uint32_t v = node * 0x9E3779B9U;
  v = (v ^ v >> 16) * 0x85EBCA6BU;
  v = (v ^ v >> 13) * 0xC2B2AE35U;
  return v ^ v >> 16;
}

float distance(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  const double x = double{a[0]} - double{b[0]};
  const double y = double{a[1]} - double{b[1]};
  const double z = double{a[2]} - double{b[2]};
  return static_cast<float>(std::sqrt(x * x + y * y + z * z));
}

std::uint32_t steps(float distance, float step, std::uint32_t most) {
  if (!(step > 0))
    return 0;
  return std::min(static_cast<std::uint32_t>(std::lround(std::max(distance / step, 0.0F))), most);
}

} // namespace

ClusterPacker::ClusterPacker(const VesselTree& tree)
    : tree_{tree}, packed_at_(tree.nodes(), nowhere), places_(tree.nodes(), nowhere) {
  arrays_.nodes.reserve(tree.nodes() + tree.nodes() / 16);
}

void ClusterPacker::pack(std::span<const std::uint32_t> segments) {
  members_.assign(segments.begin(), segments.end());
  for (const std::uint32_t node : members_)
    places_[node] = 0;
  find_references();
  sort_members();
  number();
  VesselCluster cluster = frame();
  pack_nodes(cluster);
  arrays_.clusters.push_back(cluster);
  arrays_.segments += members_.size();
  clear();
}

ClusterArrays ClusterPacker::finish() {
  for (std::uint32_t& source : arrays_.sources)
    source = packed_at_[source];
  return std::move(arrays_);
}

void ClusterPacker::find_references() {
  const auto refer = [&](std::uint32_t node, bool is_parent) {
    places_[node] = 0;
    references_.push_back({node, is_parent, tree_.positions_mm[node]});
  };
  for (const std::uint32_t node : members_)
    if (const std::uint32_t parent = tree_.parents[node]; !here(parent))
      refer(parent, true);
  const std::size_t parents = references_.size();
  for (std::size_t i = 0; i < parents; ++i) {
    const std::uint32_t grandparent = tree_.parents[references_[i].node];
    if (grandparent != no_parent && !here(grandparent))
      refer(grandparent, false);
  }
}

void ClusterPacker::sort_members() {
  std::ranges::sort(members_, [this](std::uint32_t a, std::uint32_t b) {
    return std::tuple{tree_.orders[b], lot(a)} < std::tuple{tree_.orders[a], lot(b)};
  });
}

void ClusterPacker::number() {
  const auto first = static_cast<std::uint32_t>(arrays_.nodes.size());
  std::uint32_t place = 0;
  for (const Reference& reference : references_) {
    places_[reference.node] = place;
    arrays_.sources.push_back(reference.node); // its packed index comes at the end
    std::uint32_t& at = packed_at_[reference.node];
    if (tree_.parents[reference.node] == no_parent && at == nowhere)
      at = first + place;
    ++place;
  }
  for (const std::uint32_t node : members_) {
    packed_at_[node] = first + place;
    places_[node] = place++;
  }
}

// What is there for a direction comes as near as it can while the direction stays.
void ClusterPacker::shorten_directions(TreeBox& box) {
  const float farthest = box.longest_side() / 4;
  TreeBox enlarged = box;
  for (Reference& direction : references_) {
    if (direction.is_parent)
      continue;
    for (const Reference& reference : references_) {
      if (tree_.parents[reference.node] != direction.node || !reference.is_parent)
        continue;
      const std::array<float, 3>& parent = tree_.positions_mm[reference.node];
      const float length = distance(direction.at, parent);
      if (farthest > 0 && length > farthest)
        for (std::size_t axis = 0; axis < 3; ++axis)
          direction.at[axis] =
              parent[axis] + (direction.at[axis] - parent[axis]) * (farthest / length);
      break;
    }
    enlarged.include(direction.at);
  }
  box = enlarged;
}

VesselCluster ClusterPacker::frame() {
  TreeBox box;
  float smallest = std::numeric_limits<float>::max();
  float largest = thinnest_vessel_mm;
  const auto include = [&](std::uint32_t node) {
    box.include(tree_.positions_mm[node]);
    const float radius = std::max(tree_.radii_mm[node], thinnest_vessel_mm);
    smallest = std::min(smallest, radius);
    largest = std::max(largest, radius);
  };
  for (const Reference& reference : references_)
    if (reference.is_parent)
      include(reference.node);
  std::ranges::for_each(members_, include);
  shorten_directions(box);

  VesselCluster cluster{};
  cluster.origin_mm = box.lower;
  for (std::size_t axis = 0; axis < 3; ++axis)
    cluster.step_mm[axis] = (box.upper[axis] - box.lower[axis]) / vessel_place_steps;
  cluster.smallest_radius_mm = smallest;
  cluster.log2_radius_step = std::log2(largest / smallest) / vessel_radius_steps;
  cluster.first_node = static_cast<std::uint32_t>(arrays_.nodes.size());
  cluster.references = static_cast<std::uint8_t>(references_.size());
  cluster.nodes = static_cast<std::uint8_t>(references_.size() + members_.size());
  cluster.branch = tree_.branches[members_.front()];
  for (const std::uint32_t node : members_) {
    const float length =
        distance(tree_.positions_mm[node], tree_.positions_mm[tree_.parents[node]]);
    cluster.length_mm += length;
    cluster.side_area_mm2 += 2 * tree_.radii_mm[node] * length;
  }
  auto member = members_.rbegin();
  for (std::size_t order = 0; order < cluster.nodes_from_order.size(); ++order) {
    member = std::find_if(member, members_.rend(),
                          [&](std::uint32_t node) { return tree_.orders[node] >= order; });
    cluster.nodes_from_order[order] =
        static_cast<std::uint8_t>(cluster.references + (members_.rend() - member));
  }
  return cluster;
}

PackedNode ClusterPacker::pack_node(const VesselCluster& cluster, std::uint32_t node,
                                    const std::array<float, 3>& at, unsigned order) const {
  const auto place = [&](std::size_t axis) {
    return steps(at[axis] - cluster.origin_mm[axis], cluster.step_mm[axis], vessel_place_steps);
  };
  const std::uint32_t z = place(2);
  const float thickness =
      std::max(tree_.radii_mm[node], thinnest_vessel_mm) / cluster.smallest_radius_mm;
  const std::uint32_t radius =
      steps(std::log2(thickness), cluster.log2_radius_step, vessel_radius_steps);
  const std::uint32_t parent = tree_.parents[node];
  const std::uint32_t index = parent != no_parent && here(parent) ? places_[parent] : places_[node];
  return {place(0) | place(1) << 14 | z << 28, z >> 4 | radius << 10 | index << 20 | order << 28};
}

void ClusterPacker::note_error(const VesselCluster& cluster, std::uint32_t node,
                               PackedNode packed) {
  const VesselNode found = unpack(cluster, packed);
  const float radius = std::max(tree_.radii_mm[node], thinnest_vessel_mm);
  ClusterError& error = arrays_.error;
  error.position_um =
      std::max(error.position_um, 1000 * distance(found.position_mm, tree_.positions_mm[node]));
  error.relative_radius =
      std::max(error.relative_radius, std::fabs(found.radius_mm - radius) / radius);
}

void ClusterPacker::pack_nodes(VesselCluster& cluster) {
  for (const Reference& reference : references_) {
    arrays_.nodes.push_back(pack_node(cluster, reference.node, reference.at, reference_order));
    if (reference.is_parent)
      note_error(cluster, reference.node, arrays_.nodes.back());
  }
  for (const std::uint32_t node : members_) {
    arrays_.nodes.push_back(pack_node(cluster, node, tree_.positions_mm[node], tree_.orders[node]));
    note_error(cluster, node, arrays_.nodes.back());
  }
  // Of what is drawn, as it will be unpacked.
  for (std::size_t i = cluster.references; i < cluster.nodes; ++i) {
    const PackedNode end = arrays_.nodes[cluster.first_node + i];
    const PackedNode start = arrays_.nodes[cluster.first_node + end.parent()];
    const float radius = unpack(cluster, end).radius_mm;
    cluster.largest_radius_mm =
        std::max({cluster.largest_radius_mm, radius,
                  segment_start_radius(unpack(cluster, start).radius_mm, radius)});
  }
}

void ClusterPacker::clear() {
  for (const Reference& reference : references_)
    places_[reference.node] = nowhere;
  for (const std::uint32_t node : members_)
    places_[node] = nowhere;
  references_.clear();
}

} // namespace octascope::pipeline
