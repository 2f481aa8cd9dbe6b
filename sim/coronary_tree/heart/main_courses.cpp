#include "sim/coronary_tree/heart/main_courses.h"

#include <span>

#include "sim/coronary_tree/heart/heart_wall.h"
#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

using Places = std::vector<Vector3>;

constexpr double fat_mm = 1.2;      // how far the arteries' axes lie above the muscle
constexpr double groove_mm = 17.5;  // height of the groove below the atria
constexpr double straight_mm = -20; // below this height the grooves run straight to the apex
constexpr double apex_mm = -58;

// Seen from the base, towards x and z.
struct Bearing {
  double x;
  double z;
};

// On the outside of the heart, at that height, in that direction from an axis within both
// ventricles.
Vector3 on_surface(double y, Bearing bearing) {
  constexpr double axis_x = -5;
  constexpr double axis_z = 4;
  const double size = std::sqrt(bearing.x * bearing.x + bearing.z * bearing.z);
  const double bx = bearing.x / size;
  const double bz = bearing.z / size;
  double reach = 0;
  for (const Spheroid& s : {left_outside, right_outside}) {
    const double radius = s.radius_at_mm(y);
    const double cx = axis_x - s.centre.x;
    const double cz = axis_z - s.centre.z;
    const double middle = -(cx * bx + cz * bz);
    const double inner = middle * middle - (cx * cx + cz * cz - radius * radius);
    if (inner > 0)
      reach = std::max(reach, middle + std::sqrt(inner));
  }
  return {axis_x + reach * bx, y, axis_z + reach * bz};
}

// Where the two ventricles' outsides meet: in front (side 1) or at the back (side −1).
Vector3 groove_between(double y, double side) {
  const double at = std::max(y, straight_mm);
  const Vector3 apart = right_outside.centre - left_outside.centre;
  const double distance = std::sqrt(apart.x * apart.x + apart.z * apart.z);
  const double ux = apart.x / distance;
  const double uz = apart.z / distance;
  const double r1 = left_outside.radius_at_mm(at);
  const double r2 = right_outside.radius_at_mm(at);
  const double along = (r1 * r1 - r2 * r2 + distance * distance) / (2 * distance);
  const double off = side * std::sqrt(std::max(0.0, r1 * r1 - along * along));
  const double narrower = left_outside.radius_at_mm(y) / r1;
  return {narrower * (along * ux + off * uz), y, narrower * (along * uz - off * ux)};
}

void down_the_groove(Places& places, double from_mm, double side) {
  for (double y = from_mm; y >= apex_mm; y -= 4)
    places.push_back(groove_between(y, side));
}

void round_the_base(Places& places, std::span<const Bearing> bearings) {
  constexpr int steps = 8;
  for (std::size_t i = 0; i + 1 < bearings.size(); ++i)
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      places.push_back(on_surface(groove_mm, {(1 - t) * bearings[i].x + t * bearings[i + 1].x,
                                              (1 - t) * bearings[i].z + t * bearings[i + 1].z}));
    }
}

Places resampled(const Places& places, double spacing) {
  Places result{places.front()};
  double to_go = spacing;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Vector3 step = places[i] - places[i - 1];
    const double size = length(step);
    double along = to_go;
    for (; along <= size; along += spacing)
      result.push_back(places[i - 1] + (along / size) * step);
    to_go = along - size;
  }
  return result;
}

void smooth(Places& places, int times) {
  for (int n = 0; n < times; ++n) {
    Places before = places;
    for (std::size_t i = 1; i + 1 < places.size(); ++i)
      places[i] = 0.25 * (before[i - 1] + before[i + 1]) + 0.5 * before[i];
  }
}

// Sideways along the surface, by up to about a millimetre and a half, over some ten.
void wind(Places& places, std::size_t first, std::uint64_t seed) {
  const Places before = places;
  for (std::size_t i = first; i + 1 < places.size(); ++i) {
    const double fade = std::min(1.0, static_cast<double>(i - first) / 8);
    const Vector3 outward = epicardium_outward(before[i]);
    const Vector3 side = unit(cross(before[i + 1] - before[i - 1], outward), {1, 0, 0});
    const auto along = static_cast<float>(i);
    const auto wave = static_cast<double>(smooth_noise(seed, along / 9, 0.5F)) +
                      0.35 * static_cast<double>(smooth_noise(seed, along / 3.5F, 7.5F));
    places[i] = held_at_depth(before[i] + 1.5 * fade * wave * side, -fat_mm);
  }
}

Places control_places(pipeline::VesselBranch branch) {
  Places places;
  switch (branch) {
  case pipeline::VesselBranch::lad:
    places = {{0, 24, 7}, {1.5, 25, 12}, {4.5, 25, 18}, {7.5, 22.5, 23}};
    down_the_groove(places, 18, 1);
    break;
  case pipeline::VesselBranch::lcx: {
    places = {{1.5, 24, 6}, {6, 25, 9}, {12, 24.5, 12}, {18, 22, 14}, {22, 19, 13}};
    constexpr Bearing bearings[]{{0.86, 0.36}, {1, -0.1}, {0.8, -0.65}, {0.3, -1}, {0.1, -1}};
    round_the_base(places, bearings);
    for (double y = groove_mm - 3; y >= -40; y -= 4)
      places.push_back(on_surface(y, {0.1, -1}));
    break;
  }
  case pipeline::VesselBranch::rca:
  case pipeline::VesselBranch::unknown: {
    places = {{-6, 24, 10}, {-8, 25, 16}, {-11, 25, 23}, {-15, 23, 30}, {-19, 20, 35}};
    const Vector3 back = groove_between(groove_mm, -1);
    const Vector3 end = unit({back.x + 5, 0, back.z - 4}, {-1, 0, 0});
    const Bearing bearings[]{{-0.45, 1}, {-1, 0.7}, {-1, 0}, {-1, -0.3}, {end.x, end.z}};
    round_the_base(places, bearings);
    down_the_groove(places, groove_mm - 2, -1);
    break;
  }
  }
  return places;
}

} // namespace

Vector3 Course::at(double along_mm) const {
  const double place = std::max(0.0, along_mm) / spacing_mm;
  const std::size_t i = std::min(static_cast<std::size_t>(place), places_.size() - 2);
  return places_[i] + (place - static_cast<double>(i)) * (places_[i + 1] - places_[i]);
}

Vector3 Course::direction(double along_mm) const {
  return unit(at(along_mm + spacing_mm) - at(along_mm - spacing_mm), {0, -1, 0});
}

Course::Nearest Course::nearest(Vector3 p) const {
  // In strides first, then among the neighbours of the best: courses bend gently.
  constexpr std::size_t stride = 6;
  const auto square = [&](std::size_t i) { return dot(p - places_[i], p - places_[i]); };
  const auto best_of = [&](std::size_t first, std::size_t end, std::size_t step) {
    std::size_t best = first;
    for (std::size_t i = first; i < end; i += step)
      if (square(i) < square(best))
        best = i;
    return best;
  };
  const std::size_t rough = best_of(0, places_.size(), stride);
  const std::size_t best =
      best_of(rough - std::min(rough, stride), std::min(rough + stride + 1, places_.size()), 1);
  return {spacing_mm * static_cast<double>(best), std::sqrt(square(best))};
}

Course main_course(pipeline::VesselBranch branch, std::uint64_t seed) {
  Places places = resampled(control_places(branch), Course::spacing_mm);
  smooth(places, 50);
  constexpr std::size_t stem = 16; // from the aorta to the groove
  wind(places, stem, hash(seed, static_cast<std::uint64_t>(branch)));
  smooth(places, 3);
  return Course{resampled(places, Course::spacing_mm)};
}

} // namespace octascope::sim
