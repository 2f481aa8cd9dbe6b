// Debounces one switch contact.
//
// A change is reported once the contact has kept its new level for the settling time; shorter
// changes (bounces, interference) are suppressed. A press is therefore reported one settling time
// after the last bounce; its time stamp is when the contact came to rest.
//
// Pure logic over explicit times, for simulated and real pedals. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::hal {

struct SwitchChange {
  TimePoint time; // when the contact reached the level it then kept
  bool closed = false;
};

class SwitchDebouncer {
public:
  explicit SwitchDebouncer(Duration settling = std::chrono::milliseconds{5})
      : settling_(settling) {}

  // Sets the contact's level from `t` on; repeating a level has no effect. Call settle(t) first.
  // Times must not decrease.
  void contact(TimePoint t, bool closed) {
    if (closed == contact_)
      return;
    if (contact_ != closed_)
      ++bounces_;
    contact_ = closed;
    since_ = t;
  }

  // Returns, once, the change that has settled by `now`.
  std::optional<SwitchChange> settle(TimePoint now) {
    const auto certain = due();
    if (!certain || *certain > now)
      return std::nullopt;
    closed_ = contact_;
    return SwitchChange{since_, closed_};
  }

  // When settle() will return a change if the contact keeps its level.
  std::optional<TimePoint> due() const {
    if (contact_ == closed_)
      return std::nullopt;
    return since_ + settling_;
  }

  // The level last returned by settle().
  bool closed() const { return closed_; }

  // Changes since construction that did not last for the settling time.
  std::uint64_t bounces() const { return bounces_; }

  // To an open contact, with no pending change.
  void reset() { contact_ = closed_ = false; }

private:
  Duration settling_;
  TimePoint since_{};
  bool contact_ = false;
  bool closed_ = false;
  std::uint64_t bounces_ = 0;
};

} // namespace octascope::hal
