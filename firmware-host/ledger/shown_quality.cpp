#include "firmware-host/ledger/shown_quality.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace octascope::firmware_host {

namespace {

std::uint64_t sum_of(std::span<const std::uint64_t> counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

// Empty where nothing was counted.
std::optional<QualityRange> range_of(std::span<const std::uint64_t> counts, double unit) {
  const std::uint64_t all = sum_of(counts);
  if (all == 0)
    return std::nullopt;
  const auto of_rank = [&](std::uint64_t rank) {
    std::size_t value = 0;
    for (std::uint64_t passed = counts[0]; passed < rank; passed += counts[value])
      ++value;
    return static_cast<double>(value) * unit;
  };
  return QualityRange{.median = of_rank((all + 1) / 2), .worst = of_rank(1)};
}

} // namespace

void ShownQuality::add(ui::Technique technique, const ui::DrawQuality& quality) {
  const long percent = std::lround(quality.resolution * 100);
  ++resolutions_[static_cast<std::size_t>(std::clamp(percent, 0L, 100L))];
  if (technique != ui::Technique::surface)
    ++steps_[static_cast<std::size_t>(std::clamp(quality.steps, 0, ui::full_quality.steps))];
}

QualitySummary ShownQuality::summary() const {
  return {.frames = sum_of(resolutions_),
          .resolution = range_of(resolutions_, 0.01),
          .steps = range_of(steps_, 1)};
}

} // namespace octascope::firmware_host
