#include "ui/auto_window.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>

#include "pipeline/level_scale.h"

namespace octascope::ui {

namespace {

using Histogram = std::array<std::uint64_t, 256>;

constexpr int b_scan_stride = 4;
constexpr double brightest_share = 0.001; // of all voxels, beyond the window's upper end
constexpr float noise_spreads = 2.0F;     // how many spreads of the noise lie below the window
constexpr float smallest_size_db = 15;

Histogram histogram_of(const pipeline::Volume& volume) {
  Histogram histogram{};
  for (int b = 0; b < volume.geometry.b_scans; b += b_scan_stride) {
    if (volume.b_scan_states[static_cast<std::size_t>(b)] == pipeline::BScanState::missing)
      continue;
    for (const std::uint8_t level : volume.b_scan(b))
      ++histogram[level];
  }
  histogram.front() = 0; // "nothing at all" is no noise
  return histogram;
}

// The lowest level that `share` of the counts do not exceed.
std::size_t quantile(std::span<const std::uint64_t> counts, double share) {
  const auto total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  const auto rank = static_cast<std::uint64_t>(share * static_cast<double>(total));
  std::uint64_t below = 0;
  for (std::size_t level = 0; level < counts.size(); ++level) {
    below += counts[level];
    if (below > rank)
      return level;
  }
  return counts.size() - 1;
}

} // namespace

std::optional<DisplayWindow> suggest_window(const pipeline::Volume& volume) {
  const Histogram histogram = histogram_of(volume);
  const auto peak = std::max_element(histogram.begin(), histogram.end());
  if (*peak == 0)
    return std::nullopt;
  const auto noise = static_cast<std::size_t>(peak - histogram.begin());
  // Tissue only adds to the upper side: the lower half shows the noise alone.
  const std::size_t one_sigma_below = quantile(std::span{histogram}.first(noise + 1), 0.32);
  const auto spread = static_cast<float>(std::max<std::size_t>(noise - one_sigma_below, 1));
  const float lower = static_cast<float>(noise) + noise_spreads * spread;
  const auto upper = static_cast<float>(quantile(histogram, 1 - brightest_share));
  const float offset_db = pipeline::level_db(lower);
  return DisplayWindow{offset_db,
                       std::max(pipeline::level_db(upper) - offset_db, smallest_size_db)};
}

} // namespace octascope::ui
