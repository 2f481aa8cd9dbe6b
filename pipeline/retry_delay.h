// When to try an absent device again: soon at first, then more and more rarely.
#pragma once

#include <algorithm>

#include "hal/clock.h"

namespace octascope::pipeline {

// One thread. 0.1 s after the first failure, doubling up to 2 s; success() starts over.
class RetryDelay {
public:
  bool due(hal::TimePoint now) const { return now >= next_; }

  void failure(hal::TimePoint now) {
    next_ = now + delay_;
    delay_ = std::min(2 * delay_, longest);
  }
  void success() {
    delay_ = shortest;
    next_ = hal::TimePoint{};
  }

  hal::TimePoint next() const { return next_; }

private:
  static constexpr hal::Duration shortest = std::chrono::milliseconds{100};
  static constexpr hal::Duration longest = std::chrono::seconds{2};

  hal::Duration delay_ = shortest;
  hal::TimePoint next_;
};

} // namespace octascope::pipeline
