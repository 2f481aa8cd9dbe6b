#include "ui/vessels/view/vessel_flight.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace octascope::ui {

namespace {

using pipeline::VesselBranch;
using pipeline::VesselCluster;
using pipeline::VesselClusters;

constexpr float end_mm_per_pixel = 0.004F;
constexpr float turn_deg = 180;
constexpr float unknown = -1; // length

// A segment that can be flown along.
struct Thick {
  std::uint32_t node;   // in VesselClusters::nodes
  std::uint32_t parent; // likewise; where that makes no thick segment, the way begins
  glm::vec3 from_mm;
  glm::vec3 to_mm;
  float way_mm = unknown; // from the root to its end
};

glm::vec3 place_of(const VesselCluster& cluster, pipeline::PackedNode node) {
  const auto place = unpack(cluster, node).position_mm;
  return {place[0], place[1], place[2]};
}

// In the order of their nodes; of every branch, or one.
std::vector<Thick> thick_segments(const VesselClusters& tree, bool every, VesselBranch branch) {
  std::vector<Thick> thick;
  std::size_t copies = 0; // in clusters before this one
  for (const VesselCluster& cluster : tree.clusters) {
    const auto sources = tree.sources.subspan(copies, cluster.references);
    copies += cluster.references;
    if (!every && cluster.branch != branch)
      continue;
    const auto nodes = tree.nodes.subspan(cluster.first_node, cluster.nodes);
    for (std::size_t i = cluster.references; i < cluster.nodes_from_order[least_order_kept_visible];
         ++i) {
      const std::uint32_t up = nodes[i].parent();
      thick.push_back({cluster.first_node + static_cast<std::uint32_t>(i),
                       up < sources.size() ? sources[up] : cluster.first_node + up,
                       place_of(cluster, nodes[up]), place_of(cluster, nodes[i])});
    }
  }
  return thick;
}

const Thick* find(std::span<const Thick> thick, std::uint32_t node) {
  const auto found = std::ranges::lower_bound(thick, node, {}, &Thick::node);
  return found != thick.end() && found->node == node ? &*found : nullptr;
}

void measure_ways(std::vector<Thick>& thick) {
  std::vector<std::size_t> way;
  for (std::size_t i = 0; i < thick.size(); ++i) {
    const Thick* at = &thick[i];
    while (at != nullptr && at->way_mm == unknown) {
      way.push_back(static_cast<std::size_t>(at - thick.data()));
      at = find(thick, at->parent);
    }
    float reached = at != nullptr ? at->way_mm : 0;
    for (; !way.empty(); way.pop_back()) {
      Thick& next = thick[way.back()];
      reached += glm::distance(next.from_mm, next.to_mm);
      next.way_mm = reached;
    }
  }
}

// From the mouth to the end of the longest way.
std::vector<glm::vec3> longest_way(const VesselClusters& tree) {
  if (tree.sources.empty())
    return {};
  std::vector<Thick> thick = thick_segments(tree, false, VesselBranch::lad);
  if (thick.empty())
    thick = thick_segments(tree, true, VesselBranch::unknown);
  measure_ways(thick);
  std::vector<glm::vec3> way;
  const auto last = std::ranges::max_element(thick, {}, &Thick::way_mm);
  for (const Thick* at = last == thick.end() ? nullptr : &*last; at != nullptr;
       at = find(thick, at->parent)) {
    way.push_back(at->to_mm);
    if (find(thick, at->parent) == nullptr)
      way.push_back(at->from_mm);
  }
  std::ranges::reverse(way);
  return way;
}

} // namespace

VesselFlight::VesselFlight(const VesselClusters& tree, int width, int height)
    : whole_{make_benchmark_view(BenchmarkView::whole, tree, width, height)}, height_{height} {
  fly_to(whole_.target_mm);
  for (const glm::vec3& place_mm : longest_way(tree))
    fly_to(place_mm);
}

void VesselFlight::fly_to(const glm::vec3& place_mm) {
  const float step = course_mm_.empty() ? 0 : glm::distance(course_mm_.back(), place_mm);
  reached_mm_.push_back(reached_mm_.empty() ? 0 : reached_mm_.back() + step);
  course_mm_.push_back(place_mm);
}

glm::vec3 VesselFlight::place(float reached_mm) const {
  const auto next = std::ranges::upper_bound(reached_mm_, reached_mm);
  if (next == reached_mm_.end())
    return course_mm_.back();
  const auto i = static_cast<std::size_t>(next - reached_mm_.begin());
  const float step = reached_mm_[i] - reached_mm_[i - 1];
  return glm::mix(course_mm_[i - 1], course_mm_[i], (reached_mm - reached_mm_[i - 1]) / step);
}

float VesselFlight::closer() const {
  return std::min(end_mm_per_pixel / whole_.mm_per_pixel, 0.999F);
}

float VesselFlight::pixels() const {
  const float closing = -std::log(closer());
  const float middle = length_mm() / whole_.mm_per_pixel * closing / (1 - closer());
  return std::max(middle, closing * static_cast<float>(height_) / 2);
}

VesselView VesselFlight::at(float t) const {
  const float scale = std::pow(closer(), t);
  VesselView view = whole_;
  view.mm_per_pixel *= scale;
  view.yaw_deg += turn_deg * t;
  view.target_mm = place(length_mm() * (1 - scale) / (1 - closer()));
  return view;
}

} // namespace octascope::ui
