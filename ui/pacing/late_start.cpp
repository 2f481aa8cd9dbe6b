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

// The first of `refresh` and whole periods from it that is not before `time`.
hal::TimePoint first_from(hal::TimePoint refresh, hal::Duration period, hal::TimePoint time) {
  const hal::Duration ahead = time - refresh;
  const std::int64_t down = ahead / period; // towards zero
  return refresh + (down + (ahead > down * period ? 1 : 0)) * period;
}

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
  const hal::Duration margin = std::max(share(margin_), shortest_margin);
  const hal::Duration needed = predicted() + margin;
  if (needed > share(most_busy))
    return now;
  planned_ = first_from(*refresh, period, now + needed - margin / 2);
  return std::max(now, *planned_ - needed);
}

hal::TimePoint LateStart::next_look(hal::TimePoint began, hal::TimePoint now,
                                    std::optional<hal::TimePoint> refresh, hal::Duration period) {
  const hal::TimePoint from = std::max(now, began + period / 2);
  const hal::TimePoint next = begin(from, refresh, period);
  return next > from ? next : began + period;
}

hal::TimePoint LateStart::seen(hal::TimePoint drawn, std::optional<hal::TimePoint> refresh,
                               hal::Duration period) {
  return refresh ? first_from(*refresh, period, drawn) : drawn;
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
