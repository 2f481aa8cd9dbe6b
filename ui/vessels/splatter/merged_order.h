// Fewer segments for the same coverage.
#pragma once

#include <algorithm>
#include <cstdint>

namespace octascope::ui {

// How many of a cluster's segments of one order are drawn, in their (random) order: the first
// `whole` of them wider by `widening`, then one by `last_widening` (0: none).
struct MergedOrder {
  std::uint32_t whole;
  float widening;
  float last_widening;
};

// The most segments that one can stand for.
inline constexpr float most_merged = 16;

// Segments thinner than `detail_px` (radius) are drawn with about that radius and proportionally
// fewer of them, so that the expected coverage stays the same. The last one's width takes the
// remainder, so everything is continuous in both radii. Source: R. L. Cook, J. Halstead, M. Planck,
// D. Ryu, "Stochastic simplification of aggregate detail", ACM Transactions on Graphics 26 (2007).
inline MergedOrder merged_order(float radius_px, float detail_px, std::uint32_t segments) {
  if (radius_px >= detail_px)
    return {segments, 1, 0};
  const float widening = std::min(detail_px / radius_px, most_merged);
  const float drawn = static_cast<float>(segments) / widening;
  const auto whole = std::min(static_cast<std::uint32_t>(drawn), segments);
  return {whole, widening, (drawn - static_cast<float>(whole)) * widening};
}

} // namespace octascope::ui
