#include "pipeline/volume/upper_border.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include "pipeline/volume/level_scale.h"

namespace octascope::pipeline {

namespace {

constexpr std::size_t first_bin = 4; // two more than are blanked: there the background's rest fades
constexpr std::size_t block_bins = 8;
constexpr std::size_t fewest_depths = 48;
constexpr int most_looked_at = 64;

// Sums of eight counts, so that nothing is rounded.
constexpr int as_sum(double db) {
  return static_cast<int>(db / static_cast<double>(level_step_db) * block_bins);
}
constexpr int most_sum = 255 * static_cast<int>(block_bins);

struct LookedAt {
  int border = 0;
  int brightest = 0;
};

using Histogram = std::array<int, most_sum + 1>;

LookedAt look_at(std::span<const std::uint8_t> a_scan, Histogram& blocks) {
  LookedAt found;
  for (std::size_t z = first_bin; z + block_bins <= a_scan.size(); z += block_bins) {
    const auto block = a_scan.subspan(z, block_bins);
    const int sum = std::accumulate(block.begin(), block.end(), 0);
    ++blocks[static_cast<std::size_t>(sum)];
    found.brightest = std::max(found.brightest, sum);
    if (z == first_bin)
      found.border = sum;
  }
  return found;
}

int lower_quartile(const Histogram& blocks) {
  const int all = std::accumulate(blocks.begin(), blocks.end(), 0);
  int below = 0;
  for (std::size_t sum = 0; sum < blocks.size(); ++sum) {
    below += blocks[sum];
    if (4 * below >= all)
      return static_cast<int>(sum);
  }
  return most_sum;
}

} // namespace

BorderCount count_at_upper_border(std::span<const std::uint8_t> levels, int depths,
                                  int a_scans) noexcept {
  const auto length = static_cast<std::size_t>(depths);
  if (length < fewest_depths || a_scans < 1)
    return {};
  // Evenly spread, from the middle of the first part to that of the last.
  const int looked_at = std::min(a_scans, most_looked_at);
  std::array<LookedAt, most_looked_at> found;
  Histogram blocks{};
  for (int i = 0; i < looked_at; ++i) {
    const auto a = static_cast<std::size_t>((2LL * i + 1) * a_scans / (2LL * looked_at));
    found[static_cast<std::size_t>(i)] = look_at(levels.subspan(a * length, length), blocks);
  }
  const int floor = lower_quartile(blocks);
  BorderCount count{.looked_at = looked_at};
  for (const LookedAt& one : std::span{found}.first(static_cast<std::size_t>(looked_at)))
    if (one.border >= floor + as_sum(lit_above_floor_db) &&
        one.border >= one.brightest - as_sum(lit_below_brightest_db))
      ++count.lit;
  return count;
}

} // namespace octascope::pipeline
