#include "ui/vessels/hybrid/vessel_split.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace octascope::ui {

namespace {

// Of the cluster's box, no nearer than the near distance.
float nearest_mm(const VesselScene& scene, const pipeline::VesselCluster& cluster) {
  constexpr auto half_steps = static_cast<float>(pipeline::vessel_place_steps) / 2;
  const glm::vec3 half =
      half_steps * glm::vec3{cluster.step_mm[0], cluster.step_mm[1], cluster.step_mm[2]};
  const glm::vec3 middle =
      glm::vec3{cluster.origin_mm[0], cluster.origin_mm[1], cluster.origin_mm[2]} + half;
  const float distance =
      scene.camera.depth_of(glm::vec3{scene.world_from_tree * glm::vec4{middle, 1}});
  return std::max(distance - glm::length(half), scene.camera.near_mm);
}

std::uint8_t nodes_for_gl(const VesselScene& scene, const pipeline::VesselCluster& cluster,
                          float gl_radius_px) {
  const float radius_mm = gl_radius_px * nearest_mm(scene, cluster) / scene.pixels_per_unit();
  if (!(cluster.largest_radius_mm >= radius_mm))
    return cluster.references;
  std::uint8_t taken = cluster.references;
  for (std::size_t order = cluster.nodes_from_order.size(); order-- > 0;) {
    const std::uint8_t end = cluster.nodes_from_order[order];
    if (end == taken)
      continue;
    // The first of an order was drawn by lot: it speaks for the others.
    if (unpack(cluster, scene.tree.nodes[cluster.first_node + taken]).radius_mm < radius_mm)
      break;
    taken = end;
  }
  return taken;
}

} // namespace

void split_by_radius(const VesselScene& scene, float gl_radius_px, VesselSplit& split) {
  split.resize(scene.tree.clusters.size());
  std::ranges::transform(
      scene.tree.clusters, split.begin(), [&](const pipeline::VesselCluster& cluster) {
        return std::isinf(gl_radius_px) ? cluster.references
                                        : nodes_for_gl(scene, cluster, gl_radius_px);
      });
}

} // namespace octascope::ui
