#include "ui/vessels/view/vessel_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "ui/vessels/view/dense_place.h"

namespace octascope::ui {

namespace {

constexpr float nearest_share = 0.5F; // of the target's distance
constexpr float cue_heights = 2;
constexpr float filled_share = 0.96F; // of the picture, by the whole tree
constexpr int centring_rounds = 3;
constexpr float middle_mm_per_pixel = 0.020F;
constexpr float close_mm_per_pixel = 0.002F;

struct Axes {
  glm::vec3 forward, right, up;
};

Axes axes_of(const VesselView& view) {
  const float yaw = glm::radians(view.yaw_deg);
  const float tilt = glm::radians(view.tilt_deg);
  Axes axes;
  axes.forward =
      -glm::vec3{std::sin(yaw) * std::cos(tilt), std::sin(tilt), std::cos(yaw) * std::cos(tilt)};
  axes.right = glm::vec3{std::cos(yaw), 0, -std::sin(yaw)};
  axes.up = glm::cross(axes.right, axes.forward);
  return axes;
}

float tangent(float aspect) {
  return std::tan(glm::radians(field_of_view_deg) / 2) / std::min(aspect, 1.0F);
}

float aspect_of(int width, int height) {
  return static_cast<float>(width) / static_cast<float>(height);
}

float distance_of(const VesselView& view, int width, int height) {
  return view.mm_per_pixel * static_cast<float>(height) / (2 * tangent(aspect_of(width, height)));
}

// Of the bounds, from the eye along the view.
struct Depths {
  float nearest, farthest;
};
Depths depths_of(const VesselView& view, const VesselBounds& bounds, float distance) {
  const Axes axes = axes_of(view);
  const float middle = distance + glm::dot(bounds.middle_mm() - view.target_mm, axes.forward);
  const float reach = glm::dot(glm::abs(axes.forward), bounds.extents_mm() / 2.0F);
  return {middle - reach, middle + reach};
}

glm::vec3 corner_of(const VesselBounds& bounds, unsigned corner) {
  return {(corner & 1U) != 0 ? bounds.upper_mm.x : bounds.lower_mm.x,
          (corner & 2U) != 0 ? bounds.upper_mm.y : bounds.lower_mm.y,
          (corner & 4U) != 0 ? bounds.upper_mm.z : bounds.lower_mm.z};
}

// Of a cluster, with its whole thickness.
VesselBounds bounds_of(const pipeline::VesselCluster& cluster) {
  VesselBounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const float extent = cluster.step_mm[i] * static_cast<float>(pipeline::vessel_place_steps);
    bounds.lower_mm[axis] = cluster.origin_mm[i] - cluster.largest_radius_mm;
    bounds.upper_mm[axis] = cluster.origin_mm[i] + extent + cluster.largest_radius_mm;
  }
  return bounds;
}

// Calls reach(place, radius) with what may lie farthest out, seen from `target`: to the right, up,
// ahead. A cluster whose box may pass what was reached so far, as `passes` says of its corners, is
// looked at node by node, since boxes of large vessels are mostly empty.
template <class Passes, class Reach>
void for_each_far_place(const pipeline::VesselClusters& tree, const Axes& axes,
                        const glm::vec3& target_mm, const Passes& passes, const Reach& reach) {
  const auto seen = [&](const glm::vec3& place) {
    const glm::vec3 from = place - target_mm;
    return glm::vec3{glm::dot(from, axes.right), glm::dot(from, axes.up),
                     glm::dot(from, axes.forward)};
  };
  for (const pipeline::VesselCluster& cluster : tree.clusters) {
    const VesselBounds bounds = bounds_of(cluster);
    bool may_pass = false;
    for (unsigned corner = 0; corner < 8 && !may_pass; ++corner)
      may_pass = passes(seen(corner_of(bounds, corner)));
    if (!may_pass)
      continue;
    const auto nodes = tree.nodes.subspan(cluster.first_node, cluster.nodes);
    for (const pipeline::PackedNode packed : nodes.subspan(cluster.references))
      for (const pipeline::PackedNode end : {packed, nodes[packed.parent()]}) {
        const pipeline::VesselNode node = unpack(cluster, end);
        reach(seen({node.position_mm[0], node.position_mm[1], node.position_mm[2]}),
              std::min(node.radius_mm, cluster.largest_radius_mm));
      }
  }
}

} // namespace

VesselView fit_whole_tree(VesselView view, const pipeline::VesselClusters& tree, int width,
                          int height) {
  view.target_mm = {};
  if (tree.clusters.empty())
    return view;
  const Axes axes = axes_of(view);
  glm::vec3 lower{std::numeric_limits<float>::max()};
  glm::vec3 upper{std::numeric_limits<float>::lowest()};
  for_each_far_place(
      tree, axes, view.target_mm,
      [&](const glm::vec3& corner) { return corner != glm::clamp(corner, lower, upper); },
      [&](const glm::vec3& place, float radius) {
        lower = glm::min(lower, place - radius);
        upper = glm::max(upper, place + radius);
      });
  const glm::vec3 middle = 0.5F * (lower + upper);
  const float aspect = aspect_of(width, height);
  const float slope = filled_share * tangent(aspect);
  // Nearer things reach farther out on the picture, so the middle of what is seen is found by
  // shifting the target until both sides touch alike.
  glm::vec2 centre{middle};
  float distance = 0;
  for (int round = 0; round < centring_rounds; ++round) {
    view.target_mm = centre.x * axes.right + centre.y * axes.up + middle.z * axes.forward;
    distance = std::numeric_limits<float>::min();
    const auto needed = [&](const glm::vec3& place, float radius) {
      return std::max((std::abs(place.y) + radius) / slope - place.z,
                      (std::abs(place.x) + radius) / (slope * aspect) - place.z);
    };
    for_each_far_place(
        tree, axes, view.target_mm,
        [&](const glm::vec3& corner) { return needed(corner, 0) > distance; },
        [&](const glm::vec3& place, float radius) {
          distance = std::max(distance, needed(place, radius));
        });
    glm::vec2 lowest{std::numeric_limits<float>::max()};
    glm::vec2 highest{std::numeric_limits<float>::lowest()};
    for_each_far_place(
        tree, axes, view.target_mm,
        [&](const glm::vec3& corner) {
          const glm::vec2 on_screen = glm::vec2{corner} * (distance / (distance + corner.z));
          return on_screen != glm::clamp(on_screen, lowest, highest);
        },
        [&](const glm::vec3& place, float radius) {
          const float nearness = distance / (distance + place.z);
          lowest = glm::min(lowest, (glm::vec2{place} - radius) * nearness);
          highest = glm::max(highest, (glm::vec2{place} + radius) * nearness);
        });
    centre += 0.5F * (lowest + highest);
  }
  view.mm_per_pixel = distance * 2 * tangent(aspect) / static_cast<float>(height);
  return view;
}

VesselBounds vessel_bounds(const pipeline::VesselClusters& tree) {
  VesselBounds bounds;
  if (tree.clusters.empty())
    return bounds;
  bounds = bounds_of(tree.clusters.front());
  for (const pipeline::VesselCluster& cluster : tree.clusters) {
    const VesselBounds more = bounds_of(cluster);
    bounds.lower_mm = glm::min(bounds.lower_mm, more.lower_mm);
    bounds.upper_mm = glm::max(bounds.upper_mm, more.upper_mm);
  }
  return bounds;
}

namespace {

void project(Camera& camera) {
  const float top = camera.near_mm * camera.tan_half_height;
  camera.view_projection = glm::frustum(-top * camera.aspect, top * camera.aspect, -top, top,
                                        camera.near_mm, camera.far_mm) *
                           glm::lookAt(camera.eye, camera.eye + camera.forward, camera.up);
}

} // namespace

Camera make_vessel_camera(const VesselView& view, const VesselBounds& bounds, int width,
                          int height) {
  const Axes axes = axes_of(view);
  const float distance = distance_of(view, width, height);
  const Depths depths = depths_of(view, bounds, distance);
  Camera camera;
  camera.forward = axes.forward;
  camera.right = axes.right;
  camera.up = axes.up;
  camera.eye = view.target_mm - distance * axes.forward;
  camera.near_mm = std::max(depths.nearest, nearest_share * distance);
  camera.far_mm = std::max(depths.farthest, 1.01F * camera.near_mm);
  camera.aspect = aspect_of(width, height);
  camera.tan_half_height = tangent(camera.aspect);
  project(camera);
  return camera;
}

Camera turned(Camera camera, float right_px, float up_px, int height) {
  const float px = 2 * camera.tan_half_height / static_cast<float>(height);
  camera.forward =
      glm::normalize(camera.forward + px * (right_px * camera.right + up_px * camera.up));
  camera.right = glm::normalize(glm::cross(camera.forward, camera.up));
  camera.up = glm::cross(camera.right, camera.forward);
  project(camera);
  return camera;
}

VesselLook with_cue(VesselLook look, const VesselView& view, const VesselBounds& bounds, int width,
                    int height) {
  const float distance = distance_of(view, width, height);
  const Depths depths = depths_of(view, bounds, distance);
  const float span = cue_heights * view.mm_per_pixel * static_cast<float>(height);
  look.cue_near_mm = std::max({depths.nearest, distance - span, nearest_share * distance});
  look.cue_far_mm = std::max(std::min(depths.farthest, distance + span), 1.01F * look.cue_near_mm);
  return look;
}

std::string_view to_string(BenchmarkView view) {
  switch (view) {
  case BenchmarkView::whole: return "whole";
  case BenchmarkView::middle: return "middle";
  case BenchmarkView::close: return "close";
  }
  return "whole";
}

VesselView make_benchmark_view(BenchmarkView view, const pipeline::VesselClusters& tree, int width,
                               int height) {
  const VesselBounds bounds = vessel_bounds(tree);
  VesselView made = fit_whole_tree({}, tree, width, height);
  if (view == BenchmarkView::whole)
    return made;
  made.mm_per_pixel = view == BenchmarkView::middle ? middle_mm_per_pixel : close_mm_per_pixel;
  const Axes axes = axes_of(made);
  const glm::vec2 size_mm =
      made.mm_per_pixel * glm::vec2{static_cast<float>(width), static_cast<float>(height)};
  const glm::vec3 across = view == BenchmarkView::middle
                               ? glm::vec3{size_mm, glm::length(bounds.extents_mm())}
                               : glm::vec3{size_mm, size_mm.y};
  made.target_mm = densest_place(tree, {axes.right, axes.up, axes.forward}, across);
  return made;
}

} // namespace octascope::ui
