#include "pipeline/neighbour_average.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pipeline/cpu_clones.h"

namespace octascope::pipeline {

namespace {

constexpr std::uint32_t one = 65536;

// The average of three B-scans, `after` and `result` may be anywhere but in each other.
OCTASCOPE_CPU_CLONES
void average(const std::uint8_t* before, const std::uint8_t* here, const std::uint8_t* after,
             std::uint32_t weight_before, std::uint32_t weight_here, std::uint32_t weight_after,
             std::size_t count, std::uint8_t* __restrict result) {
  for (std::size_t i = 0; i < count; ++i)
    result[i] = static_cast<std::uint8_t>(
        (weight_before * before[i] + weight_here * here[i] + weight_after * after[i] + one / 2) /
        one);
}

// The same where the weights are multiples of 1/256, as the usual ones are: 16-bit arithmetic.
OCTASCOPE_CPU_CLONES
void average_16_bit(const std::uint8_t* before, const std::uint8_t* here, const std::uint8_t* after,
                    std::uint16_t weight_before, std::uint16_t weight_here,
                    std::uint16_t weight_after, std::size_t count,
                    std::uint8_t* __restrict result) {
  for (std::size_t i = 0; i < count; ++i)
    result[i] = static_cast<std::uint8_t>(
        static_cast<std::uint16_t>(weight_before * before[i] + weight_here * here[i] +
                                   weight_after * after[i] + 128) >>
        8);
}

} // namespace

hal::Result<NeighbourAverage> NeighbourAverage::create(const NeighbourWeights& weights) {
  const auto good = [](double weight) { return std::isfinite(weight) && weight >= 0; };
  if (!good(weights.before) || !good(weights.here) || !good(weights.after) || weights.here == 0)
    return hal::fail(hal::Fault::invalid_argument,
                     fmt::format("neighbour weights are {}, {}, {}, expected numbers from 0 with "
                                 "the middle one more than 0",
                                 weights.before, weights.here, weights.after));
  return NeighbourAverage{weights};
}

NeighbourAverage::NeighbourAverage(const NeighbourWeights& weights) {
  for (std::size_t pattern = 0; pattern < weights_.size(); ++pattern) {
    const double before = (pattern & 1U) != 0 ? weights.before : 0;
    const double after = (pattern & 2U) != 0 ? weights.after : 0;
    const double sum = before + weights.here + after;
    FixedWeights& fixed = weights_[pattern];
    fixed.before = static_cast<std::uint32_t>(std::lround(before / sum * one));
    fixed.after =
        std::min(static_cast<std::uint32_t>(std::lround(after / sum * one)), one - fixed.before);
    fixed.here = one - fixed.before - fixed.after;
  }
}

void NeighbourAverage::apply(std::span<std::uint8_t> levels, std::span<const BScanState> states,
                             std::size_t b_scan_voxels) noexcept {
  const std::size_t b_scans = states.size();
  for (std::size_t start = 0; start < b_scan_voxels; start += chunk) {
    const std::size_t count = std::min(chunk, b_scan_voxels - start);
    std::uint8_t* before = originals_[0].data();
    std::uint8_t* here = originals_[1].data();
    bool has_before = false;
    for (std::size_t b = 0; b < b_scans; ++b) {
      if (states[b] == BScanState::missing) {
        has_before = false;
        continue;
      }
      std::uint8_t* levels_here = levels.data() + b * b_scan_voxels + start;
      const bool has_after = b + 1 < b_scans && states[b + 1] != BScanState::missing;
      const FixedWeights& w = weights_[(has_before ? 1U : 0U) + (has_after ? 2U : 0U)];
      std::copy_n(levels_here, count, here);
      // A neighbour that does not exist has the weight 0; any readable memory stands in for it.
      const std::uint8_t* after = has_after ? levels_here + b_scan_voxels : here;
      if (((w.before | w.here | w.after) & 0xFFU) == 0 && w.here < one)
        average_16_bit(before, here, after, static_cast<std::uint16_t>(w.before >> 8),
                       static_cast<std::uint16_t>(w.here >> 8),
                       static_cast<std::uint16_t>(w.after >> 8), count, levels_here);
      else
        average(before, here, after, w.before, w.here, w.after, count, levels_here);
      std::swap(before, here);
      has_before = true;
    }
  }
}

} // namespace octascope::pipeline
