// Fewer segments for the same coverage.
#pragma once

#include <algorithm>
#include <cstdint>

namespace octascope::ui {

// So many of a cluster's segments of one order are drawn, in their order, which was drawn by lot:
// the first `whole` of them wider by `widening`, then one by `last_widening` (0: none).
struct MergedOrder {
  std::uint32_t whole;
  float widening;
  float last_widening;
};

// No segment stands for more than so many.
inline constexpr float most_merged = 16;

// Segments thinner than `detail_px` (radius) are drawn with about that radius, and in that
// proportion fewer of them, so that they cover as much of the picture as all would, in expectation.
// The last one's width takes what is over, so all changes smoothly with both radii. Source: R. L.
// Cook, J. Halstead, M. Planck, D. Ryu, "Stochastic simplification of aggregate detail", ACM
// Transactions on Graphics 26 (2007).
inline MergedOrder merged_order(float radius_px, float detail_px, std::uint32_t segments) {
  if (radius_px >= detail_px)
    return {segments, 1, 0};
  const float widening = std::min(detail_px / radius_px, most_merged);
  const float drawn = static_cast<float>(segments) / widening;
  const auto whole = std::min(static_cast<std::uint32_t>(drawn), segments);
  return {whole, widening, (drawn - static_cast<float>(whole)) * widening};
}

} // namespace octascope::ui
