#include "sim/devices/sim_galvo_trigger.h"

namespace octascope::sim {

using hal::DeviceState;
using hal::ErrorCode;
using hal::TimePoint;

SimGalvoTrigger::SimGalvoTrigger(GalvoLink& link, hal::Clock& clock, const FaultSchedule* faults)
    : link_(link), clock_(clock), probe_(faults, pipeline::Device::galvo_trigger) {}

hal::Result<> SimGalvoTrigger::do_open(const hal::GalvoTriggerConfig& config) {
  const TimePoint now = clock_.now();
  if (probe_.unplugged(now))
    return hal::fail(ErrorCode::absent,
                     "simulated galvo trigger: not found, expected its line; the "
                     "fault script has unplugged it, try again later");
  probe_.watch_plug(now);
  config_ = config;
  line_is_low_ = now;
  set_state(DeviceState::ready);
  return {};
}

hal::Result<TimePoint> SimGalvoTrigger::do_pulse() {
  clock_.sleep_until(line_is_low_); // no edge can rise before the last one fell
  const TimePoint now = clock_.now();
  if (probe_.pulled_since_last_look(now)) {
    set_state(DeviceState::failed);
    return hal::fail(ErrorCode::disconnected,
                     "simulated galvo trigger: its line went away while in use; the fault script "
                     "has unplugged it, close it and open it again");
  }
  line_is_low_ = now + config_.pulse_width;
  if (probe_.strike(pipeline::Fault::missed_pulse, now) == nullptr)
    link_.pulse(now);
  return now;
}

void SimGalvoTrigger::do_close() {
  set_state(DeviceState::absent);
}

} // namespace octascope::sim
