#include "ui/transfer/histogram.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr std::size_t most_voxels = 1U << 19U;
constexpr std::size_t blank_bins = 2;

// Neighbouring voxels often have the same level: four counters in turn do not wait for one another.
using Counters = std::array<std::array<std::uint32_t, 256>, 4>;

void count(std::span<const std::uint8_t> levels, Counters& counters) {
  std::size_t i = 0;
  for (; i + 4 <= levels.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k)
      ++counters[k][levels[i + k]];
  for (; i < levels.size(); ++i)
    ++counters[0][levels[i]];
}

} // namespace

std::array<float, LevelHistogram::bars> LevelHistogram::shares() const {
  std::array<float, bars> shares{};
  for (std::size_t level = 1; level < counts.size(); ++level)
    shares[level / 2] += static_cast<float>(counts[level]);
  const float highest = *std::ranges::max_element(shares);
  if (highest > 0)
    for (float& share : shares)
      share = std::sqrt(share / highest);
  return shares;
}

LevelHistogram make_level_histogram(const pipeline::Volume& volume) {
  const pipeline::VolumeGeometry& g = volume.geometry;
  const auto depths = static_cast<std::size_t>(g.depths);
  const auto per_b_scan = static_cast<std::size_t>(g.a_scans);
  const std::size_t a_scans = per_b_scan * static_cast<std::size_t>(g.b_scans);
  const std::size_t stride = a_scans * depths / most_voxels + 1;
  const std::size_t first = std::min(blank_bins, depths);
  Counters counters{};
  for (std::size_t a_scan = 0; a_scan < a_scans; a_scan += stride)
    if (volume.b_scan_states[a_scan / per_b_scan] != pipeline::BScanState::missing)
      count(std::span{volume.levels}.subspan(a_scan * depths + first, depths - first), counters);
  LevelHistogram histogram;
  for (std::size_t level = 0; level < histogram.counts.size(); ++level)
    for (const auto& counter : counters)
      histogram.counts[level] += counter[level];
  return histogram;
}

} // namespace octascope::ui
