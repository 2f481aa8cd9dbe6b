// The courses of the three arteries, from the root of the aorta along the grooves of the heart.
//
// The right one (RCA) runs round the right side in the groove below the atrium, and down the groove
// between the ventricles at the back; the left anterior descending (LAD) down that groove in front
// to the apex; the circumflex (LCX) round the left side.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/heart/vector3.h"

namespace octascope::sim {

// A curve with points at equal distances.
class Course {
public:
  static constexpr double spacing_mm = 1;

  explicit Course(std::vector<Vector3> places) : places_{std::move(places)} {}

  double length_mm() const { return spacing_mm * static_cast<double>(places_.size() - 1); }

  // The point at a distance along it; straight on beyond its end.
  Vector3 at(double along_mm) const;
  Vector3 direction(double along_mm) const;

  struct Nearest {
    double along_mm;
    double distance_mm;
  };
  Nearest nearest(Vector3 p) const;

private:
  std::vector<Vector3> places_;
};

// Winds gently, depending on the seed.
Course main_course(pipeline::VesselBranch branch, std::uint64_t seed);

} // namespace octascope::sim
