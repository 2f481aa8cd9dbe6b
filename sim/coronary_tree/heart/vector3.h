// Points and directions. Only sums, products, quotients and square roots, so that every machine
// with IEEE 754 arithmetic gives the same bits (this folder is compiled without contraction to
// fused multiply-add).
#pragma once

#include <algorithm>
#include <cmath>

namespace octascope::sim {

struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

inline Vector3 operator+(Vector3 a, Vector3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector3 operator-(Vector3 a, Vector3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector3 operator*(double s, Vector3 a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double dot(Vector3 a, Vector3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector3 cross(Vector3 a, Vector3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vector3 a) {
  return std::sqrt(dot(a, a));
}

// `otherwise` if the vector has no direction.
inline Vector3 unit(Vector3 a, Vector3 otherwise) {
  const double size = length(a);
  return size > 1e-9 ? (1 / size) * a : otherwise;
}

// `a` without its part along the unit vector `axis`.
inline Vector3 across(Vector3 a, Vector3 axis) {
  return a - dot(a, axis) * axis;
}

// Any unit vector perpendicular to a unit vector.
inline Vector3 any_across(Vector3 axis) {
  const Vector3 least = std::abs(axis.x) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
  return unit(across(least, axis), {0, 0, 1});
}

// Turns from `from` towards `to` (unit vectors), keeping the cosine of the angle within the range.
inline Vector3 turned(Vector3 from, Vector3 to, double least_cosine, double most_cosine) {
  const double cosine = std::clamp(dot(from, to), least_cosine, most_cosine);
  const Vector3 side = unit(across(to, from), any_across(from));
  return cosine * from + std::sqrt(std::max(0.0, 1 - cosine * cosine)) * side;
}

} // namespace octascope::sim
