// The wall that the vessels feed: a pig's left ventricle, with the right one around part of it.
//
// The left ventricle is a prolate spheroid, the right one a second, thinner spheroid beside it;
// both are cut off at the base. The tree's frame, in millimetres: y from the apex to the base, z to
// the front (anterior), x to the animal's left; the origin on the left ventricle's axis, 60 mm
// above the apex. From base to apex it is 80 mm; the left wall is 8.5 mm thick, the right one 3.5.
#pragma once

#include "sim/coronary_tree/heart/vector3.h"

namespace octascope::sim {

inline constexpr double base_mm = 20; // the plane of the valves

struct Spheroid {
  Vector3 centre;
  double radius_mm;      // across
  double half_length_mm; // along y

  // Approximate distance to the surface, negative inside; exact on it.
  double distance_mm(Vector3 p) const;
  Vector3 outward(Vector3 p) const;
  double radius_at_mm(double y) const; // of the circle at that height; 0 beyond the ends
};

inline constexpr Spheroid left_outside{{0, 0, 0}, 28, 60};
inline constexpr Spheroid left_inside{{0, 0, 0}, 19.5, 52};
inline constexpr Spheroid right_outside{{-13.5, 6, 12}, 26.5, 47};
inline constexpr Spheroid right_inside{{-13.5, 6, 12}, 23, 43.5};

// Depth below the outer surface of the heart (epicardium), negative outside.
double depth_mm(Vector3 p);

// Unit vector away from the heart at its outer surface.
Vector3 epicardium_outward(Vector3 p);

// Whether a place is muscle: not in a ventricle, not outside, not above the base.
bool in_muscle(Vector3 p);

// Upper bound of the distance to muscle; 0 inside.
double outside_muscle_mm(Vector3 p);

// The place itself if it is in the muscle, else one nearby that is.
Vector3 held_in_muscle(Vector3 p);

// The nearest place at that depth below the epicardium (negative: in the fat upon it).
Vector3 held_at_depth(Vector3 p, double depth);

} // namespace octascope::sim
