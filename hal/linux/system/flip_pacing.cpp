#include "hal/linux/system/flip_pacing.h"

#include <algorithm>

namespace octascope::hal::linux_backend {

TimePoint FlipPacer::completed(const FlipTimes& flip) {
  const bool credible =
      flip.stamp && *flip.stamp >= flip.submitted && *flip.stamp <= flip.received + period_;
  const bool rested = flip.submitted > next_allowed_ + period_; // which tells nothing
  completed_ = std::max(completed_, credible ? *flip.stamp : flip.received);
  // A tenth of a period: a monitor's refresh is steadier than that. Within it the output's own pace
  // counts, else the clock's nominal one would drift against it until a refresh is missed.
  const TimePoint next_refresh = std::min(next_allowed_, completed_) + period_;
  next_allowed_ = next_refresh - completed_ > period_ / 10 ? next_refresh : completed_;
  if (flip.mode_set)
    paces_itself_ = false;
  else if (!rested)
    paces_itself_ = next_allowed_ == completed_ && flip.received - flip.submitted >= period_ / 20;
  return completed_;
}

std::optional<TimePoint> FlipPacer::next_refresh() const {
  return paces_itself_ ? std::optional{completed_ + period_} : std::nullopt;
}

} // namespace octascope::hal::linux_backend
