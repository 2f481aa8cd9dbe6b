// The splatter's target: distance and colour of the nearest vessel at each pixel.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace octascope::ui {

// One number per pixel: the bits of its distance along the view (float, mm, > 0) above its colour
// (red in the lowest 8 bits, premultiplied; alpha: the share of the pixel that vessels cover).
// Positive floats sort like their bits, so the smallest number is the nearest vessel, in whatever
// order threads write. At equal distances the smaller colour wins. The distance is that at the
// pixel's centre: infinite where a vessel covers only a part beside it.
using DepthPixel = std::uint64_t;

inline constexpr DepthPixel depth_pixel(float distance_mm, std::uint32_t rgba) {
  return DepthPixel{std::bit_cast<std::uint32_t>(distance_mm)} << 32U | rgba;
}
// Infinitely far and transparent.
inline constexpr DepthPixel empty_depth_pixel =
    depth_pixel(std::numeric_limits<float>::infinity(), 0);

// Rows from the top.
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<DepthPixel> pixels;

  // Allocates only to grow. Does not clear the pixels.
  void resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (count > pixels.size())
      pixels.resize(count);
  }
  DepthPixel at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  std::uint32_t rgba(int x, int y) const { return static_cast<std::uint32_t>(at(x, y)); }
  // Infinity where there is no vessel.
  float distance_mm(int x, int y) const {
    return std::bit_cast<float>(static_cast<std::uint32_t>(at(x, y) >> 32U));
  }
};

} // namespace octascope::ui
