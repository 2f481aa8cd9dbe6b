#include "ui/vessels/sections/near_segments.h"

#include <algorithm>
#include <array>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vector_relational.hpp>

namespace octascope::ui {

namespace {

using pipeline::VesselCluster;

glm::vec3 to_vector(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

} // namespace

// The box, asked by what lies in the tree's frame.
class NearSegments::Reach {
public:
  Reach(const pipeline::RigidTransform& volume_from_tree, const VolumeBox& box) : box_{box} {
    for (glm::length_t row = 0; row < 3; ++row) {
      const auto& from = volume_from_tree.rotation[static_cast<std::size_t>(row)];
      for (glm::length_t column = 0; column < 3; ++column)
        turn_[column][row] = static_cast<float>(from[static_cast<std::size_t>(column)]);
      shift_mm_[row] = static_cast<float>(volume_from_tree.shift_mm[static_cast<std::size_t>(row)]);
    }
    spread_ = {glm::abs(turn_[0]), glm::abs(turn_[1]), glm::abs(turn_[2])};
  }

  glm::vec3 placed(const std::array<float, 3>& in_tree_mm) const {
    return turn_ * to_vector(in_tree_mm) + shift_mm_;
  }

  bool meets(const VesselCluster& cluster) const {
    const glm::vec3 half =
        0.5F * static_cast<float>(pipeline::vessel_place_steps) * to_vector(cluster.step_mm);
    const glm::vec3 middle = turn_ * (to_vector(cluster.origin_mm) + half) + shift_mm_;
    const glm::vec3 around = spread_ * half + cluster.largest_radius_mm;
    return meets(middle - around, middle + around);
  }

  bool meets(const NearSegment& s) const {
    return meets(glm::min(s.from_mm - s.from_radius_mm, s.to_mm - s.to_radius_mm),
                 glm::max(s.from_mm + s.from_radius_mm, s.to_mm + s.to_radius_mm));
  }

private:
  bool meets(const glm::vec3& lower_mm, const glm::vec3& upper_mm) const {
    return glm::all(glm::lessThanEqual(lower_mm, box_.upper_mm)) &&
           glm::all(glm::greaterThanEqual(upper_mm, box_.lower_mm));
  }

  VolumeBox box_;
  glm::mat3 turn_{1};
  glm::vec3 shift_mm_{0};
  glm::mat3 spread_{1}; // of a box: the turn's absolute values
};

void NearSegments::reserve(std::size_t clusters) {
  near_.reserve(clusters);
  found_.reserve(2 * most_segments + static_cast<std::size_t>(pipeline::largest_cluster));
}

void NearSegments::choose(const pipeline::VesselClusters& tree, const Reach& reach) {
  std::size_t segments = 0;
  for (std::uint32_t i = 0; i < tree.clusters.size(); ++i)
    if (reach.meets(tree.clusters[i])) {
      near_.push_back({i, tree.clusters[i].largest_radius_mm});
      segments += tree.clusters[i].segments();
    }
  if (segments <= most_examined)
    return;
  std::ranges::sort(near_, std::ranges::greater{}, &NearCluster::thickest_mm);
  segments = 0;
  const auto beyond = std::ranges::find_if(near_, [&](const NearCluster& cluster) {
    segments += tree.clusters[cluster.index].segments();
    return segments > most_examined;
  });
  near_.erase(beyond, near_.end());
  complete_ = false;
}

void NearSegments::look_into(const pipeline::VesselClusters& tree, const VesselCluster& cluster,
                             const Reach& reach) {
  const auto nodes = tree.nodes.subspan(cluster.first_node, cluster.nodes);
  std::array<glm::vec3, pipeline::largest_cluster> places_mm;
  std::array<float, pipeline::largest_cluster> radii_mm;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const pipeline::VesselNode node = pipeline::unpack(cluster, nodes[i]);
    places_mm[i] = reach.placed(node.position_mm);
    radii_mm[i] = node.radius_mm;
  }
  for (std::size_t i = cluster.references; i < nodes.size(); ++i) {
    const std::size_t parent = nodes[i].parent();
    const NearSegment segment{places_mm[parent],
                              places_mm[i],
                              pipeline::segment_start_radius(radii_mm[parent], radii_mm[i]),
                              radii_mm[i],
                              static_cast<std::uint8_t>(nodes[i].order()),
                              cluster.branch};
    if (reach.meets(segment))
      found_.push_back(segment);
  }
  examined_ += cluster.segments();
}

void NearSegments::keep_thickest() {
  std::ranges::nth_element(found_, found_.begin() + most_segments, std::ranges::greater{},
                           &NearSegment::thickest_mm);
  found_.erase(found_.begin() + most_segments, found_.end());
  complete_ = false;
}

void NearSegments::find(const pipeline::VesselClusters& tree,
                        const pipeline::RigidTransform& volume_from_tree, const VolumeBox& box) {
  const Reach reach{volume_from_tree, box};
  near_.clear();
  found_.clear();
  examined_ = 0;
  complete_ = true;
  choose(tree, reach);
  for (const NearCluster& cluster : near_) {
    look_into(tree, tree.clusters[cluster.index], reach);
    if (found_.size() > 2 * most_segments)
      keep_thickest();
  }
  if (found_.size() > most_segments)
    keep_thickest();
}

} // namespace octascope::ui
