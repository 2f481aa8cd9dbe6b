// Takes the bounce out of one switch contact.
//
// A change counts when the contact has rested at its new level for the settling time; whatever is
// shorter, a bounce or a spike of interference, is never seen. The price is that a press is told
// one settling time after the last bounce; its time stamp says when the contact came to rest.
//
// Pure logic over explicit times, for twins and real pedals alike. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::hal {

struct SwitchChange {
  TimePoint time; // when the contact reached the level at which it then stayed
  bool closed = false;
};

class SwitchDebouncer {
public:
  explicit SwitchDebouncer(Duration settling = std::chrono::milliseconds{5})
      : settling_(settling) {}

  // The contact's level from `t` on. Call settle(t) first, with times that do not decrease.
  // Repeating the same level changes nothing.
  void contact(TimePoint t, bool closed) {
    if (closed == contact_)
      return;
    if (contact_ != closed_)
      ++bounces_;
    contact_ = closed;
    since_ = t;
  }

  // The change that is certain by `now`, once.
  std::optional<SwitchChange> settle(TimePoint now) {
    const auto certain = due();
    if (!certain || *certain > now)
      return std::nullopt;
    closed_ = contact_;
    return SwitchChange{since_, closed_};
  }

  // When settle() will have something to say if the contact stays as it is.
  std::optional<TimePoint> due() const {
    if (contact_ == closed_)
      return std::nullopt;
    return since_ + settling_;
  }

  // As last told by settle().
  bool closed() const { return closed_; }

  // How often a change did not last for the settling time, ever.
  std::uint64_t bounces() const { return bounces_; }

  // To an open contact, with nothing to tell.
  void reset() { contact_ = closed_ = false; }

private:
  Duration settling_;
  TimePoint since_{};
  bool contact_ = false;
  bool closed_ = false;
  std::uint64_t bounces_ = 0;
};

} // namespace octascope::hal
