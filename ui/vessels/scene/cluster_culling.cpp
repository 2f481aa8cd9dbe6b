#include "ui/vessels/scene/cluster_culling.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace octascope::ui {

namespace {

// Of rounding, in pixels: what is nearer to the edge than this counts as inside.
constexpr double margin_px = 0.01;

struct Span {
  double lowest;
  double highest;
};

struct Box {
  glm::dvec3 middle;
  glm::dvec3 half;

  Span along(const glm::dvec4& row) const {
    const glm::dvec3 direction{row};
    const double at = glm::dot(direction, middle) + row.w;
    const double reach = glm::dot(glm::abs(direction), half);
    return {at - reach, at + reach};
  }
};

Box box_of(const pipeline::VesselCluster& cluster) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    box.half[axis] = 0.5 * pipeline::vessel_place_steps * static_cast<double>(cluster.step_mm[i]);
    box.middle[axis] = static_cast<double>(cluster.origin_mm[i]) + box.half[axis];
  }
  return box;
}

double least_px(const pipeline::VesselCluster& cluster) {
  const bool kept_visible = cluster.nodes_from_order[least_order_kept_visible] > cluster.references;
  return kept_visible ? double{least_vessel_radius_px} : 0;
}

// Rows of which the picture's sides are where they are 0, positive inside.
class Sides {
public:
  explicit Sides(const VesselFrame& frame)
      : frame_{frame}, right_{static_cast<double>(frame.width) * frame.along - frame.across},
        top_{static_cast<double>(frame.height) * frame.along - frame.up} {}

  bool may_show(const Box& box, const Span& distance, double radius_mm,
                double least_radius_px) const {
    if (distance.highest < static_cast<double>(frame_.near_mm) ||
        distance.lowest - radius_mm > static_cast<double>(frame_.far_mm))
      return false;
    const double reach =
        std::max(radius_mm * frame_.pixels_per_unit, least_radius_px * distance.highest) +
        margin_px * distance.highest;
    return box.along(frame_.across).highest > -reach && box.along(frame_.up).highest > -reach &&
           box.along(right_).highest > -reach && box.along(top_).highest > -reach;
  }

private:
  const VesselFrame& frame_;
  glm::dvec4 right_;
  glm::dvec4 top_;
};

} // namespace

std::uint64_t choose_clusters(const VesselFrame& frame, const pipeline::VesselClusters& tree,
                              ClusterChoice choice, std::vector<ClusterPart>& parts) {
  const Sides sides{frame};
  std::uint64_t culled = 0;
  for (std::uint32_t i = 0; i < tree.clusters.size(); ++i) {
    const pipeline::VesselCluster& cluster = tree.clusters[i];
    const Box box = box_of(cluster);
    const Span distance = box.along(frame.along);
    const auto radius_mm = static_cast<double>(cluster.largest_radius_mm);
    const double least_radius_px = least_px(cluster);
    if (choice == ClusterChoice::visible &&
        !sides.may_show(box, distance, radius_mm, least_radius_px)) {
      culled += cluster.segments();
      continue;
    }
    const double nearest = std::max(distance.lowest, static_cast<double>(frame.near_mm));
    const double largest_px =
        std::max(radius_mm * frame.pixels_per_unit / nearest, least_radius_px);
    parts.push_back({i, cluster.segments(), static_cast<float>(largest_px)});
  }
  return culled;
}

} // namespace octascope::ui
