#include "sim/devices/bouncing_contact.h"

#include <algorithm>

namespace octascope::sim {

using hal::TimePoint;

bool BouncingContact::level() const {
  return stuck_.value_or(foot_ != (bounces_left_ % 2 == 1));
}

void BouncingContact::touch(TimePoint t) {
  debouncer_.contact(t, level());
}

void BouncingContact::foot(TimePoint t, bool pressed, const ScriptedFault* bounce) {
  if (pressed == foot_)
    return;
  foot_ = pressed;
  bounces_left_ = 0;
  if (bounce != nullptr && bounce->bounces > 0) {
    // Each bounce is one way off and one way back.
    bounces_left_ = 2 * bounce->bounces;
    bounce_step_ = bounce->bounce_spread / bounces_left_;
    next_bounce_ = t + bounce_step_;
  }
  touch(t);
}

void BouncingContact::stick(TimePoint t, std::optional<bool> level_now) {
  stuck_ = level_now;
  touch(t);
}

std::optional<TimePoint> BouncingContact::next_time() const {
  auto next = debouncer_.due();
  if (bounces_left_ > 0)
    next = next ? std::min(*next, next_bounce_) : next_bounce_;
  return next;
}

std::optional<hal::SwitchChange> BouncingContact::play_to(TimePoint t) {
  const auto change = debouncer_.settle(t);
  if (bounces_left_ > 0 && next_bounce_ <= t) {
    --bounces_left_;
    touch(next_bounce_);
    next_bounce_ += bounce_step_;
  }
  return change;
}

void BouncingContact::reset() {
  debouncer_.reset();
  foot_ = false;
  stuck_.reset();
  bounces_left_ = 0;
}

} // namespace octascope::sim
