// Sums and products of points.
#pragma once

#include <array>
#include <cmath>

#include "pipeline/vessels/rigid_transform.h"

namespace octascope::pipeline {

inline Point sum(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point difference(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point scaled(const Point& a, double by) {
  return {a[0] * by, a[1] * by, a[2] * by};
}
inline double product(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const Point& a) {
  return std::sqrt(product(a, a));
}
// Zero stays zero.
inline Point direction(const Point& a) {
  const double of = length(a);
  return of > 0 ? scaled(a, 1 / of) : a;
}

} // namespace octascope::pipeline
