// Median, 95th and 99th percentiles and maximum of a stream of durations, without keeping them.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "hal/clock.h"

namespace octascope::pipeline {

struct DurationSummary {
  std::uint64_t count = 0;
  double p50_ms = 0;
  double p95_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
};

// Logarithmic bins, 2 % wide, from 1 µs to over 100 s: a percentile is right within 1 %, the
// maximum is exact. Thread-safe: any number of threads may add and summarise at once; adding is
// two relaxed atomic operations.
class DurationStatistics {
public:
  void add(hal::Duration duration);
  DurationSummary summary() const;
  // Counts those shorter than each bound, in rising order, and not than the one before; the last
  // count is of the rest. `counts` has one more than `most_ms`.
  void histogram(std::span<const double> most_ms, std::span<std::uint64_t> counts) const;

private:
  static constexpr std::size_t bins = 1024;
  std::array<std::atomic<std::uint32_t>, bins> counts_{};
  std::atomic<std::int64_t> max_ns_{0};
};

} // namespace octascope::pipeline
