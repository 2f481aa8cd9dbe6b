#include "ui/transfer/auto_window.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>

#include "pipeline/volume/level_scale.h"

namespace octascope::ui {

namespace {

constexpr double brightest_share = 0.001; // of all voxels, beyond the window's upper end
constexpr float noise_spreads = 2.0F;     // how many spreads of the noise lie below the window
constexpr float smallest_size_db = 15;

// The lowest of the high peaks. Where tissue fills most of the volume, its peak is as high as the
// noise's, or higher.
std::size_t noise_level(std::span<const std::uint32_t> counts) {
  constexpr std::size_t reach = 8; // counts to either side that a peak stands out from
  const std::uint32_t high = std::max(*std::ranges::max_element(counts) / 4, 1U);
  for (std::size_t level = 0; level < counts.size(); ++level) {
    const std::size_t first = level > reach ? level - reach : 0;
    const auto around = counts.subspan(first, std::min(level + reach + 1, counts.size()) - first);
    if (counts[level] >= high && counts[level] == *std::ranges::max_element(around))
      return level;
  }
  return 0;
}

// The lowest level that `share` of the counts do not exceed.
std::size_t quantile(std::span<const std::uint32_t> counts, double share) {
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
  return suggest_window(make_level_histogram(volume));
}

std::optional<DisplayWindow> suggest_window(const LevelHistogram& histogram) {
  auto counts = histogram.counts;
  counts.front() = 0; // "nothing at all" is no noise
  if (*std::ranges::max_element(counts) == 0)
    return std::nullopt;
  const std::size_t noise = noise_level(counts);
  // Tissue only adds to the upper side: the lower half shows the noise alone.
  const std::size_t one_sigma_below = quantile(std::span{counts}.first(noise + 1), 0.32);
  const auto spread = static_cast<float>(std::max<std::size_t>(noise - one_sigma_below, 1));
  const float lower = static_cast<float>(noise) + noise_spreads * spread;
  const auto upper = static_cast<float>(quantile(counts, 1 - brightest_share));
  const float offset_db = pipeline::level_db(lower);
  return DisplayWindow{offset_db,
                       std::max(pipeline::level_db(upper) - offset_db, smallest_size_db)};
}

} // namespace octascope::ui
