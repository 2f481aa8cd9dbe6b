#include "tests/ui/support/vessels/reference_segments.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace octascope::tests {

namespace {

struct Place {
  glm::dvec3 at; // right, up and along the view, in mm
  double radius_mm;
};

Place seen(const ui::VesselScene& scene, const pipeline::VesselNode& node) {
  const ui::Camera& c = scene.camera;
  const glm::dvec4 local{node.position_mm[0], node.position_mm[1], node.position_mm[2], 1};
  const glm::dvec3 ray = glm::dvec3{glm::dmat4{scene.world_from_tree} * local} - glm::dvec3{c.eye};
  const double z = glm::dot(ray, glm::dvec3{c.forward});
  return {{glm::dot(ray, glm::dvec3{c.right}), glm::dot(ray, glm::dvec3{c.up}), z},
          double{node.radius_mm}};
}

std::optional<ReferenceSegment> segment_of(const ui::VesselScene& scene,
                                           const pipeline::VesselCluster& cluster,
                                           std::uint32_t index) {
  const pipeline::PackedNode node = scene.tree.nodes[index];
  const pipeline::PackedNode parent = scene.tree.nodes[cluster.first_node + node.parent()];
  Place a = seen(scene, unpack(cluster, parent));
  Place b = seen(scene, unpack(cluster, node));
  a.radius_mm = std::min(a.radius_mm, 1.5 * b.radius_mm);
  const double near_mm = scene.camera.near_mm;
  if (a.at.z < near_mm && b.at.z < near_mm)
    return std::nullopt;
  const double t = (near_mm - a.at.z) / (b.at.z - a.at.z);
  const Place middle{glm::mix(a.at, b.at, t), glm::mix(a.radius_mm, b.radius_mm, t)};
  if (a.at.z < near_mm)
    a = middle;
  else if (b.at.z < near_mm)
    b = middle;
  const double scale = scene.pixels_per_unit();
  const auto screen = [&](const Place& p) {
    return glm::dvec2{0.5 * scene.width +
                          scale * (p.at.x / p.at.z - double{scene.camera.centre_shift}),
                      0.5 * scene.height - scale * p.at.y / p.at.z};
  };
  const double least = node.order() >= 5 ? 0.5 : 0.0;
  const auto radius_px = [&](const Place& p) {
    return std::max(scale * p.radius_mm / p.at.z, least);
  };
  return ReferenceSegment{screen(a),
                          screen(b),
                          radius_px(a),
                          radius_px(b),
                          a.at.z,
                          b.at.z,
                          a.at,
                          b.at,
                          a.radius_mm,
                          b.radius_mm,
                          scene.look.colouring == ui::VesselColouring::order
                              ? ui::order_colours[node.order()]
                              : ui::branch_colours[static_cast<std::size_t>(cluster.branch)],
                          index};
}

// Where the ray (1 along the view) enters the ball a share of the way from end to end; no number
// where it misses.
double enter_ball(const ReferenceSegment& s, const glm::dvec3& ray, double share, double wider) {
  const glm::dvec3 middle = glm::mix(s.from, s.to, share);
  const double radius = wider * glm::mix(s.from_mm, s.to_mm, share);
  const double along = glm::dot(ray, middle);
  const double square = glm::dot(ray, ray);
  return (along -
          std::sqrt(along * along - square * (glm::dot(middle, middle) - radius * radius))) /
         square;
}

struct Surface {
  double mm;
  double share = 0; // of the way from end to end: 0 and 1 are balls, else it is a side
};

// The first of all the balls between the ends that the ray enters, found by trying.
Surface enter(const ReferenceSegment& s, const glm::dvec3& ray, double axis_mm, double wider) {
  constexpr int tried = 96;
  double nearest = axis_mm;
  double share = 0;
  for (int i = 0; i <= tried; ++i)
    if (const double entered = enter_ball(s, ray, i / double{tried}, wider); entered < nearest) {
      nearest = entered;
      share = i / double{tried};
    }
  for (double step = 0.5 / tried; step > 1e-5; step /= 2)
    for (const double near : {share - step, share + step})
      if (const double entered = enter_ball(s, ray, std::clamp(near, 0.0, 1.0), wider);
          entered < nearest) {
        nearest = entered;
        share = std::clamp(near, 0.0, 1.0);
      }
  return {nearest, share};
}

double stretch_of(const ReferenceSegment& s, const ui::VesselScene& scene) {
  const double slope_px = std::abs(1 / s.zb - 1 / s.za) * double{scene.pixels_per_unit()} * s.za /
                          glm::length(s.b - s.a);
  const double steep = std::min(slope_px, 2.0);
  return 1 + steep * steep;
}

// Of a wide segment beyond an end: its light and how far it is set back.
void light_end(ReferencePlace& found, const ReferenceSegment& s, const glm::dvec2& place,
               double along, double share, const ui::VesselScene& scene) {
  const glm::dvec2 way = s.b - s.a;
  const bool is_further = along > 1 ? s.zb > s.za : s.za > s.zb;
  const ReferencePlace::Light ball{found.off_px, is_further ? stretch_of(s, scene) : 1};
  const ReferencePlace::Light side{glm::length(place - s.a - along * way), 1};
  const bool on_sides = share > 0 && share < 1;
  const bool may_be_either = on_sides && (share < 0.05 || share > 0.95);
  found.lights = {on_sides ? side : ball, on_sides && !may_be_either ? side : ball};
  const double set_back = on_sides ? 0 : is_further ? 4e-5 : 2e-5;
  found.distance_mm *= 1 + set_back;
}

// Of a segment too thin for relief: the round side, as vessel_scene.h has it.
void raise_round_side(ReferencePlace& found, const ReferenceSegment& s, double t,
                      const ui::VesselScene& scene) {
  const double scale = scene.pixels_per_unit();
  const bool clamped = t <= 0 || t >= 1;
  const double steep = stretch_of(s, scene);
  const auto seen_mm = [&](double wider, double stretch) {
    const double r = wider * found.radius_px;
    const double height = std::sqrt(std::max(r * r - found.off_px * found.off_px, 0.0));
    return found.axis_mm / (1 + height * std::sqrt(stretch) / scale);
  };
  found.distance_mm = seen_mm(1, clamped ? 1 : steep);
  // Beside the ends, rounding decides whether t is clamped.
  const bool beside = t < 1e-4 || t > 1 - 1e-4;
  found.nearest_mm = seen_mm(1.001, clamped && !beside ? 1 : steep);
  found.farthest_mm = seen_mm(0.999, clamped || beside ? 1 : steep);
}

} // namespace

ReferencePlace place_in(const ReferenceSegment& s, const glm::dvec2& place,
                        const ui::VesselScene& scene) {
  const glm::dvec2 way = s.b - s.a;
  const double length2 = glm::dot(way, way);
  const bool end_on = length2 < 1e-8;
  const double along = end_on ? 0 : glm::dot(place - s.a, way) / length2;
  const double t = std::clamp(along, 0.0, 1.0);
  ReferencePlace found{glm::length(place - s.a - t * way),
                       end_on ? s.widest_px() : glm::mix(s.ra, s.rb, t),
                       1 / glm::mix(1 / s.za, 1 / s.zb, t),
                       0,
                       0,
                       0,
                       {}};
  found.lights.fill({found.off_px, 1});
  found.distance_mm = found.farthest_mm = found.nearest_mm = found.axis_mm;
  if (s.widest_px() < 8 && found.radius_px >= 0.499 && found.outside_px() < 0.01)
    raise_round_side(found, s, t, scene);
  if (s.widest_px() >= 8 && found.outside_px() < 0.01) {
    const double scale = scene.pixels_per_unit();
    const glm::dvec3 ray{(place.x - 0.5 * scene.width) / scale + double{scene.camera.centre_shift},
                         (0.5 * scene.height - place.y) / scale, 1};
    const double near_mm = scene.camera.near_mm;
    const auto seen_mm = [&](double wider) {
      return std::max(enter(s, ray, found.axis_mm, wider).mm,
                      near_mm + 0.002 * (found.axis_mm - near_mm));
    };
    found.distance_mm = seen_mm(1);
    if (along < 0 || along > 1)
      light_end(found, s, place, along, enter(s, ray, found.axis_mm, 1).share, scene);
    found.farthest_mm = seen_mm(0.999);
    found.nearest_mm = seen_mm(1.001);
  }
  return found;
}

double reference_light(double d, double radius_px, double stretch) {
  const double mean = std::numbers::pi / 4;
  const double share = std::clamp(radius_px - 0.5, 0.0, 1.0);
  const double here = std::clamp(d, 0.0, 1.0);
  const double there = std::min(stretch * (1 - here * here), 1.0);
  return 0.35 + 0.65 * std::sqrt(share * there + (1 - share) * mean * mean);
}

std::vector<ReferenceSegment> reference_segments(const ui::VesselScene& scene) {
  std::vector<ReferenceSegment> segments;
  for (const pipeline::VesselCluster& cluster : scene.tree.clusters)
    for (std::uint32_t i = cluster.references; i < cluster.nodes; ++i)
      if (const auto segment = segment_of(scene, cluster, cluster.first_node + i))
        segments.push_back(*segment);
  return segments;
}

PixelRange pixels_around(const ReferenceSegment& s, double margin_px,
                         const ui::VesselScene& scene) {
  const double reach = s.widest_px() + margin_px + 1;
  const glm::dvec2 lower = glm::min(s.a, s.b) - reach;
  const glm::dvec2 upper = glm::max(s.a, s.b) + reach;
  const auto within = [](double v, int size) {
    return static_cast<int>(std::clamp(std::floor(v), 0.0, double(size)));
  };
  return {within(lower.x, scene.width), within(lower.y, scene.height),
          within(upper.x + 1, scene.width), within(upper.y + 1, scene.height)};
}

} // namespace octascope::tests
