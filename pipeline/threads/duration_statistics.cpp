#include "pipeline/threads/duration_statistics.h"

#include <algorithm>
#include <cmath>

namespace octascope::pipeline {

namespace {

constexpr double bin_ratio = 1.02;
constexpr double first_bin_ns = 1000;

std::size_t bin_of(hal::Duration duration, std::size_t bins) {
  const double ns = std::max(static_cast<double>(duration.count()), first_bin_ns);
  const double bin = std::log(ns / first_bin_ns) / std::log(bin_ratio);
  return std::min(static_cast<std::size_t>(bin), bins - 1);
}

double middle_of_bin_ms(std::size_t bin) {
  return first_bin_ns * std::pow(bin_ratio, static_cast<double>(bin) + 0.5) * 1e-6;
}

} // namespace

void DurationStatistics::add(hal::Duration duration) {
  counts_[bin_of(duration, bins)].fetch_add(1, std::memory_order_relaxed);
  std::int64_t max = max_ns_.load(std::memory_order_relaxed);
  while (duration.count() > max &&
         !max_ns_.compare_exchange_weak(max, duration.count(), std::memory_order_relaxed)) {
  }
}

DurationSummary DurationStatistics::summary() const {
  std::array<std::uint64_t, bins> cumulated{};
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < bins; ++i)
    cumulated[i] = total += counts_[i].load(std::memory_order_relaxed);
  if (total == 0)
    return {};
  const double max_ms = static_cast<double>(max_ns_.load(std::memory_order_relaxed)) * 1e-6;
  const auto percentile = [&](double share) {
    const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(total)));
    const auto bin = std::ranges::lower_bound(cumulated, rank);
    return std::min(middle_of_bin_ms(static_cast<std::size_t>(bin - cumulated.begin())), max_ms);
  };
  return {total, percentile(0.5), percentile(0.95), percentile(0.99), max_ms};
}

void DurationStatistics::histogram(std::span<const double> most_ms,
                                   std::span<std::uint64_t> counts) const {
  std::ranges::fill(counts, 0U);
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const auto bound = std::ranges::upper_bound(most_ms, middle_of_bin_ms(bin));
    counts[static_cast<std::size_t>(bound - most_ms.begin())] +=
        counts_[bin].load(std::memory_order_relaxed);
  }
}

} // namespace octascope::pipeline
