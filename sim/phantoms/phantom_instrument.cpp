#include "sim/phantoms/phantom_instrument.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace octascope::sim {

Instrument::Pose Instrument::pose(double phase) const {
  const auto turn = static_cast<float>(2 * std::numbers::pi * (phase - std::floor(phase)));
  const Point3 tip{path_.tip.x_mm + path_.reach.x_mm * std::cos(turn),
                   path_.tip.y_mm + path_.reach.y_mm * std::sin(turn),
                   path_.tip.z_mm + path_.reach.z_mm * std::sin(turn + 0.6F)};
  const float dx = tip.x_mm - path_.hinge.x_mm;
  const float dy = tip.y_mm - path_.hinge.y_mm;
  const float dz = tip.z_mm - path_.hinge.z_mm;
  const float length = std::sqrt(dx * dx + dy * dy + dz * dz);
  const float back = path_.prong_length_mm / length;
  const Point3 fork{tip.x_mm - back * dx, tip.y_mm - back * dy, tip.z_mm - back * dz};
  // The shaft goes on behind the hinge, out of any picture.
  const Point3 handle{path_.hinge.x_mm - dx, path_.hinge.y_mm - dy, path_.hinge.z_mm - dz};
  const float across = std::hypot(dx, dy);
  const float gap = 0.5F * path_.opening_mm * (0.55F + 0.45F * std::cos(2 * turn));
  const float side_x = -dy / across * gap;
  const float side_y = dx / across * gap;

  Pose pose;
  pose.rods_[0] = {handle, fork, path_.shaft_radius_mm};
  pose.rods_[1] = {fork, {tip.x_mm + side_x, tip.y_mm + side_y, tip.z_mm}, path_.prong_radius_mm};
  pose.rods_[2] = {fork, {tip.x_mm - side_x, tip.y_mm - side_y, tip.z_mm}, path_.prong_radius_mm};
  return pose;
}

std::optional<Instrument::Top> Instrument::Pose::top_at(float x_mm, float y_mm) const {
  std::optional<Top> top;
  for (const Rod& rod : rods_) {
    const float dx = rod.to.x_mm - rod.from.x_mm;
    const float dy = rod.to.y_mm - rod.from.y_mm;
    const float off_x = x_mm - rod.from.x_mm;
    const float off_y = y_mm - rod.from.y_mm;
    const float t = std::clamp((off_x * dx + off_y * dy) / (dx * dx + dy * dy), 0.0F, 1.0F);
    const float distance_squared =
        (off_x - t * dx) * (off_x - t * dx) + (off_y - t * dy) * (off_y - t * dy);
    const float radius_squared = rod.radius_mm * rod.radius_mm;
    if (distance_squared >= radius_squared)
      continue;
    const float rise = std::sqrt(radius_squared - distance_squared);
    const float depth = rod.from.z_mm + t * (rod.to.z_mm - rod.from.z_mm) - rise;
    if (!top || depth < top->depth_mm)
      top = Top{depth, rise / rod.radius_mm};
  }
  return top;
}

std::array<float, 4> Instrument::Pose::bounds_mm() const {
  std::array<float, 4> bounds{1e9F, 1e9F, -1e9F, -1e9F};
  for (const Rod& rod : rods_) {
    for (const Point3& end : {rod.from, rod.to}) {
      bounds[0] = std::min(bounds[0], end.x_mm - rod.radius_mm);
      bounds[1] = std::min(bounds[1], end.y_mm - rod.radius_mm);
      bounds[2] = std::max(bounds[2], end.x_mm + rod.radius_mm);
      bounds[3] = std::max(bounds[3], end.y_mm + rod.radius_mm);
    }
  }
  return bounds;
}

void Instrument::fill(Column& column, const Pose& pose, float x_mm, float y_mm) {
  const std::optional<Top> top = pose.top_at(x_mm, y_mm);
  if (!top)
    return;
  // Ground steel: a mirror where it faces the beam, and a matt shine everywhere.
  const float mirror = top->facing * top->facing * top->facing * top->facing;
  column.add(Layer{.top_mm = top->depth_mm,
                   .bottom_mm = top->depth_mm + 0.035F,
                   .backscatter_counts = 60 + 60 * top->facing});
  column.add(Surface{top->depth_mm, 60 + 500 * mirror, 1});
  column.add(Surface{top->depth_mm + 0.035F, 0, 0});
}

} // namespace octascope::sim
