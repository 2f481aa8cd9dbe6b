#include "pipeline/acquisition/neighbour_average.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

constexpr std::uint32_t one = 65536;

// The average of three B-scans.
OCTASCOPE_CPU_CLONES
void average_32_bit(const std::uint8_t* before, const std::uint8_t* here, const std::uint8_t* after,
                    std::uint32_t weight_before, std::uint32_t weight_here,
                    std::uint32_t weight_after, std::size_t count,
                    std::uint8_t* __restrict result) {
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
    return hal::fail(hal::ErrorCode::invalid_argument,
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

void NeighbourAverage::average(std::span<const std::uint8_t> before,
                               std::span<const std::uint8_t> here,
                               std::span<const std::uint8_t> after,
                               std::span<std::uint8_t> result) const noexcept {
  const FixedWeights& w = weights_[(before.empty() ? 0U : 1U) + (after.empty() ? 0U : 2U)];
  // A neighbour that does not exist has the weight 0; any readable memory stands in for it.
  const std::uint8_t* first = before.empty() ? here.data() : before.data();
  const std::uint8_t* last = after.empty() ? here.data() : after.data();
  if (w.here == one)
    std::ranges::copy(here, result.begin());
  else if (((w.before | w.here | w.after) & 0xFFU) == 0)
    average_16_bit(first, here.data(), last, static_cast<std::uint16_t>(w.before >> 8),
                   static_cast<std::uint16_t>(w.here >> 8),
                   static_cast<std::uint16_t>(w.after >> 8), result.size(), result.data());
  else
    average_32_bit(first, here.data(), last, w.before, w.here, w.after, result.size(),
                   result.data());
}

} // namespace octascope::pipeline
