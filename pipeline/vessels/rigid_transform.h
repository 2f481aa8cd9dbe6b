// A turn and a shift: lengths and handedness stay.
#pragma once

#include <array>
#include <cstddef>

namespace octascope::pipeline {

using Point = std::array<double, 3>; // in mm

// `to = rotation · from + shift`; rotation by rows.
struct RigidTransform {
  std::array<std::array<double, 3>, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Point shift_mm{};

  Point apply(const Point& from) const {
    Point to = shift_mm;
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column)
        to[row] += rotation[row][column] * from[column];
    return to;
  }

  bool operator==(const RigidTransform&) const = default;
};

// First `right`, then `left`.
inline RigidTransform operator*(const RigidTransform& left, const RigidTransform& right) {
  RigidTransform product;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) {
      product.rotation[row][column] = 0;
      for (std::size_t i = 0; i < 3; ++i)
        product.rotation[row][column] += left.rotation[row][i] * right.rotation[i][column];
    }
  product.shift_mm = left.apply(right.shift_mm);
  return product;
}

inline RigidTransform inverse(const RigidTransform& transform) {
  RigidTransform back;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      back.rotation[row][column] = transform.rotation[column][row];
  const Point shift = back.apply(transform.shift_mm);
  back.shift_mm = {-shift[0], -shift[1], -shift[2]};
  return back;
}

} // namespace octascope::pipeline
