#include "tests/support/pictures/picture_counts.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace octascope::tests {

namespace {

// Every channel of the pixel there, as the largest difference from another pixel.
int difference(const std::uint8_t* a, const std::uint8_t* b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

const std::uint8_t* pixel(const pipeline::Image& picture, int x, int y) {
  return &picture
              .pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                           static_cast<std::size_t>(x))];
}

} // namespace

int count_colour(const pipeline::Image& picture, const ui::Rect& where, ui::Colour colour,
                 int tolerance) {
  if (picture.channels != 3 || picture.pixels.empty())
    return 0;
  const std::uint8_t wanted[3] = {colour.r, colour.g, colour.b};
  int count = 0;
  for (int y = where.y; y < where.bottom(); ++y) {
    for (int x = where.x; x < where.right(); ++x)
      count += difference(pixel(picture, x, y), wanted) <= tolerance;
  }
  return count;
}

int count_different(const pipeline::Image& a, const pipeline::Image& b, const ui::Rect& where,
                    int tolerance) {
  int count = 0;
  for (int y = where.y; y < where.bottom(); ++y) {
    for (int x = where.x; x < where.right(); ++x)
      count += difference(pixel(a, x, y), pixel(b, x, y)) > tolerance;
  }
  return count;
}

} // namespace octascope::tests
