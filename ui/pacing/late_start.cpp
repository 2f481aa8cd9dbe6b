#include "ui/pacing/late_start.h"

#include <algorithm>

namespace octascope::ui {

namespace {

using std::chrono::milliseconds;

constexpr double most_margin = 0.3; // of a period
constexpr double least_margin = 0.05;
constexpr hal::Duration shortest_margin = milliseconds{1};
constexpr double margin_of_a_miss = 0.04;
constexpr double margin_of_a_second = 0.02; // that it shrinks by while none is missed
constexpr int a_second = 60;                // frames
constexpr double most_busy = 0.85;          // of a period, that frames may take

// A clock that is off by a thousandth drifts by a millisecond in this time.
constexpr hal::Duration longest_known = std::chrono::seconds{1};

} // namespace

hal::Duration LateStart::predicted() const {
  return *std::ranges::max_element(costs_);
}

hal::TimePoint LateStart::begin(hal::TimePoint now, std::optional<hal::TimePoint> refresh,
                                hal::Duration period) {
  planned_.reset();
  period_ = period;
  if (!refresh || frames_ == 0 || now - *refresh > longest_known)
    return now;
  const auto share = [&](double of) {
    return hal::Duration{static_cast<std::int64_t>(of * static_cast<double>(period.count()))};
  };
  const hal::Duration needed = predicted() + std::max(share(margin_), shortest_margin);
  if (needed > share(most_busy))
    return now;
  const hal::Duration ahead = now + needed - *refresh;
  const std::int64_t periods =
      ahead <= hal::Duration{0} ? -(-ahead / period) : (ahead - hal::Duration{1}) / period + 1;
  planned_ = *refresh + periods * period;
  return *planned_ - needed;
}

void LateStart::note(hal::Duration cost, hal::TimePoint seen) {
  costs_[frames_++ % kept] = cost;
  if (!planned_)
    return;
  if (seen > *planned_ + period_ / 2) {
    margin_ = std::min(margin_ + margin_of_a_miss, most_margin);
    met_ = 0;
  } else if (++met_ == a_second) {
    margin_ = std::max(margin_ - margin_of_a_second, least_margin);
    met_ = 0;
  }
}

} // namespace octascope::ui
