#include "sim/clock/virtual_clock.h"

namespace octascope::sim {

void VirtualClock::do_sleep_until(hal::TimePoint deadline) {
  const std::int64_t target = deadline.time_since_epoch().count();
  std::int64_t now = now_ns_.load(std::memory_order_acquire);
  while (now < target && !now_ns_.compare_exchange_weak(now, target, std::memory_order_acq_rel)) {
  }
}

} // namespace octascope::sim
