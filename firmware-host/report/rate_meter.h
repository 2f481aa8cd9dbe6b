// Events per second over the last two seconds or so, for the display and the status line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/clock.h"

namespace octascope::firmware_host {

// One thread. Fed with a running total.
class RateMeter {
public:
  void update(std::uint64_t total, hal::TimePoint now);
  double per_second() const { return rate_; }

private:
  static constexpr std::size_t window = 9; // a quarter of a second apart
  static constexpr hal::Duration spacing = std::chrono::milliseconds{250};

  struct Sample {
    std::uint64_t total = 0;
    hal::TimePoint time;
  };
  std::array<Sample, window> samples_{};
  std::size_t count_ = 0;
  double rate_ = 0;
};

} // namespace octascope::firmware_host
