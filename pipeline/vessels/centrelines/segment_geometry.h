// Places on straight segments.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace octascope::pipeline {

using Position = std::array<double, 3>;

inline double distance(const Position& a, const Position& b) {
  const double x = a[0] - b[0];
  const double y = a[1] - b[1];
  const double z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

inline Position between(const Position& a, const Position& b, double share) {
  Position at{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    at[axis] = a[axis] + share * (b[axis] - a[axis]);
  return at;
}

// How far from a (0) to b (1) the place nearest to the point is.
inline double nearest_share(const Position& a, const Position& b, const Position& point) {
  double square = 0;
  double product = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    square += (b[axis] - a[axis]) * (b[axis] - a[axis]);
    product += (b[axis] - a[axis]) * (point[axis] - a[axis]);
  }
  return square > 0 ? std::clamp(product / square, 0.0, 1.0) : 0;
}

} // namespace octascope::pipeline
