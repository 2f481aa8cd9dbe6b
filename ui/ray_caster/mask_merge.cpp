#include "ui/ray_caster/mask_merge.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace octascope::ui {

namespace {

// Premultiplied; all four channels of the vessel weighed alike.
std::uint32_t with_vessel_under(std::uint32_t volume, std::uint32_t vessel) {
  const std::uint32_t left = 255 - (volume >> 24U);
  std::uint32_t merged = 0;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    const std::uint32_t sum =
        (volume >> shift & 0xFFU) + ((vessel >> shift & 0xFFU) * left + 127) / 255;
    merged |= std::min(sum, 255U) << shift;
  }
  return merged;
}

std::uint32_t mixed(std::uint32_t from, std::uint32_t to, int share_256) {
  std::uint32_t result = 0;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    const int a = static_cast<int>(from >> shift & 0xFFU);
    const int b = static_cast<int>(to >> shift & 0xFFU);
    result |= static_cast<std::uint32_t>(a + ((b - a) * share_256 + 128) / 256) << shift;
  }
  return result;
}

Rect around(const Rect& a, const Rect& b) {
  if (a.empty() || b.empty())
    return a.empty() ? b : a;
  const int left = std::min(a.x, b.x);
  const int top = std::min(a.y, b.y);
  return {left, top, std::max(a.right(), b.right()) - left, std::max(a.bottom(), b.bottom()) - top};
}

} // namespace

void merge_mask(RayImage& image, const DepthImage& vessels, float opacity, const RayImage* alone) {
  const int share = static_cast<int>(opacity * 256 + 0.5F);
  int left = image.width, right = 0, top = image.height, bottom = 0;
  for (int y = 0; y < image.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    int first = -1;
    int last = -1;
    for (int x = 0; x < image.width; ++x) {
      const std::size_t i = row + static_cast<std::size_t>(x);
      const DepthPixel vessel = vessels.pixels[i];
      if (vessel == empty_depth_pixel)
        continue;
      first = first < 0 ? x : first;
      last = x;
      std::uint32_t& pixel = image.rgba[i];
      const std::uint32_t under = with_vessel_under(pixel, static_cast<std::uint32_t>(vessel));
      pixel = alone != nullptr ? mixed(alone->rgba[i], under, share) : under;
    }
    if (first < 0)
      continue;
    left = std::min(left, first);
    right = std::max(right, last + 1);
    top = std::min(top, y);
    bottom = y + 1;
  }
  if (right == 0)
    return;
  // A transparent border, as RayImage has it.
  constexpr int border = 2;
  left = std::max(left - border, 0);
  top = std::max(top - border, 0);
  image.drawn = around(image.drawn, {left, top, std::min(right + border, image.width) - left,
                                     std::min(bottom + border, image.height) - top});
}

} // namespace octascope::ui
