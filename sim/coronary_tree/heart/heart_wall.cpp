#include "sim/coronary_tree/heart/heart_wall.h"

namespace octascope::sim {
namespace {

Vector3 scaled(const Spheroid& s, Vector3 p, double power_of_two) {
  const double across = power_of_two > 1 ? s.radius_mm * s.radius_mm : s.radius_mm;
  const double along = power_of_two > 1 ? s.half_length_mm * s.half_length_mm : s.half_length_mm;
  const Vector3 d = p - s.centre;
  return {d.x / across, d.y / along, d.z / across};
}

// Along the surface's normal until it is `distance` away from it.
Vector3 moved(const Spheroid& s, Vector3 p, double distance) {
  return p + (distance - s.distance_mm(p)) * s.outward(p);
}

} // namespace

double Spheroid::distance_mm(Vector3 p) const {
  const double reach = length(scaled(*this, p, 1));
  const double slope = length(scaled(*this, p, 2));
  return slope > 1e-12 ? reach * (reach - 1) / slope : -radius_mm;
}

Vector3 Spheroid::outward(Vector3 p) const {
  return unit(scaled(*this, p, 2), {1, 0, 0});
}

double Spheroid::radius_at_mm(double y) const {
  const double t = (y - centre.y) / half_length_mm;
  return t * t < 1 ? radius_mm * std::sqrt(1 - t * t) : 0;
}

double depth_mm(Vector3 p) {
  return -std::min(left_outside.distance_mm(p), right_outside.distance_mm(p));
}

Vector3 epicardium_outward(Vector3 p) {
  return left_outside.distance_mm(p) < right_outside.distance_mm(p) ? left_outside.outward(p)
                                                                    : right_outside.outward(p);
}

bool in_muscle(Vector3 p) {
  if (p.y > base_mm)
    return false;
  if (left_outside.distance_mm(p) <= 0)
    return left_inside.distance_mm(p) >= 0;
  return right_outside.distance_mm(p) <= 0 && right_inside.distance_mm(p) >= 0;
}

double outside_muscle_mm(Vector3 p) {
  const double left = std::max(left_outside.distance_mm(p), -left_inside.distance_mm(p));
  const double right = std::max(right_outside.distance_mm(p), -right_inside.distance_mm(p));
  return std::max({0.0, p.y - base_mm, std::min(left, right)});
}

Vector3 held_in_muscle(Vector3 p) {
  constexpr double margin = 0.02;
  for (int i = 0; i < 12; ++i) {
    if (p.y > base_mm)
      p.y = base_mm - margin;
    if (in_muscle(p))
      return p;
    if (left_inside.distance_mm(p) < 0) {
      p = moved(left_inside, p, margin);
      continue;
    }
    // In the right ventricle, between its two walls, or outside.
    const double to_left = std::abs(left_outside.distance_mm(p));
    const double right_in = right_inside.distance_mm(p);
    const double to_right = std::abs(right_in < 0 ? right_in : right_outside.distance_mm(p));
    if (to_left < to_right)
      p = moved(left_outside, p, -margin);
    else if (right_in < 0)
      p = moved(right_inside, p, margin);
    else
      p = moved(right_outside, p, -margin);
  }
  return p;
}

Vector3 held_at_depth(Vector3 p, double depth) {
  for (int i = 0; i < 3; ++i)
    p = p + (depth_mm(p) - depth) * epicardium_outward(p);
  return p;
}

} // namespace octascope::sim
