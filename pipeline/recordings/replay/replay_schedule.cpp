#include "pipeline/recordings/replay/replay_schedule.h"

#include <algorithm>
#include <cmath>

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

constexpr hal::Duration least_period = 1ms;

hal::Duration at_rate(hal::Duration recorded, double rate) {
  return hal::from_seconds(hal::to_seconds(recorded) / rate);
}

} // namespace

hal::Duration recorded_step(std::int64_t from_ns, std::int64_t to_ns) {
  if (to_ns <= from_ns)
    return {};
  constexpr hal::Duration most = 24h;
  const std::uint64_t ns = static_cast<std::uint64_t>(to_ns) - static_cast<std::uint64_t>(from_ns);
  return ns > static_cast<std::uint64_t>(most.count())
             ? most
             : hal::Duration{static_cast<std::int64_t>(ns)};
}

ReplaySchedule::ReplaySchedule(std::span<const RecordedVolume> volumes, hal::Duration period,
                               double rate) {
  period = std::clamp<hal::Duration>(period, least_period, longest_pause);
  rate = std::isfinite(rate) ? std::clamp(rate, slowest_replay, fastest_replay) : 1;
  offsets_.reserve(volumes.size());
  constexpr hal::Duration latest = hal::Duration::max() / 4;
  hal::Duration offset{};
  for (std::size_t n = 0; n < volumes.size(); ++n) {
    if (n > 0) {
      hal::Duration step = recorded_step(volumes[n - 1].published_ns, volumes[n].published_ns);
      if (step > longest_pause) {
        pauses_.push_back({n, step - shortened_pause});
        step = shortened_pause;
      } else if (step == hal::Duration{}) {
        step = period;
      }
      offset = std::min(offset + at_rate(step, rate), latest);
    }
    offsets_.push_back(offset);
  }
  length_ = offset + at_rate(period, rate);
}

hal::Duration ReplaySchedule::left_out_before(std::size_t n) const {
  const auto pause = std::ranges::lower_bound(pauses_, n, {}, &Pause::before);
  return pause != pauses_.end() && pause->before == n ? pause->left_out : hal::Duration{};
}

} // namespace octascope::pipeline
