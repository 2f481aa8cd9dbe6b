// When to try an absent device again: soon at first, then more and more rarely.
#pragma once

#include <algorithm>
#include <optional>

#include "hal/clock.h"

namespace octascope::pipeline {

// One thread. After a failure, a quarter of the time for which the device has been away by then, at
// least 0.1 s and at most 2 s: who waited for it so long hardly notices a quarter more. success()
// starts over.
class RetryDelay {
public:
  bool due(hal::TimePoint now) const { return now >= next_; }

  void failure(hal::TimePoint now) {
    if (!away_since_)
      away_since_ = now;
    next_ = now + std::clamp((now - *away_since_) / 4, shortest, longest);
  }
  void success() {
    away_since_.reset();
    next_ = hal::TimePoint{};
  }

  hal::TimePoint next() const { return next_; }

private:
  static constexpr hal::Duration shortest = std::chrono::milliseconds{100};
  static constexpr hal::Duration longest = std::chrono::seconds{2};

  std::optional<hal::TimePoint> away_since_;
  hal::TimePoint next_;
};

} // namespace octascope::pipeline
