#include "pipeline/controls/control_thread.h"

#include <array>
#include <span>

#include <fmt/format.h>

#include "pipeline/threads/heartbeat.h"

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

constexpr hal::Duration read_timeout = 50ms; // also how soon a stop is noticed

} // namespace

ControlThread::ControlThread(hal::ControlInput& input, hal::Clock& clock, FaultLog& faults,
                             Wakeup& news)
    : input_(input), clock_(clock), faults_(faults), news_(news) {}

void ControlThread::start(const ThreadSetup& setup) {
  thread_.start({"controls"}, setup, [this] { run(); });
}

void ControlThread::run() {
  std::array<hal::ControlEvent, 32> events;
  while (!thread_.stopping()) {
    Heartbeat::beat_here(clock_.now());
    if (input_.state() != hal::DeviceState::ready && !open()) {
      clock_.sleep_for(read_timeout);
      continue;
    }
    const auto count = input_.read(events, read_timeout);
    if (!count) {
      faults_.add(Device::control_input, count.error(), clock_.now());
      input_.close();
      continue;
    }
    for (const hal::ControlEvent& event : std::span{events}.first(*count))
      receive(event);
    look_for_bad_contacts();
    if (*count > 0)
      news_.post();
  }
  input_.close();
}

void ControlThread::receive(const hal::ControlEvent& event) {
  if (event.kind == hal::ControlKind::pedal_switch)
    held_.note(event.index, event.value != 0, event.time);
  if (!queue_.push(event))
    faults_.add(Fault::control_overflow, "more events than the display could take", event.time);
}

void ControlThread::look_for_bad_contacts() {
  const hal::TimePoint now = clock_.now();
  if (const auto index = held_.longest_untold(now))
    faults_.add(Fault::stuck_switch,
                fmt::format("switch {} has been down for {} s: it is stuck, or somebody stands on "
                            "it",
                            *index, hal::to_seconds(HeldSwitches::limit)),
                now);
  const std::uint64_t bounces = input_.bounces();
  if (bounces > bounces_)
    faults_.add(Fault::bounce,
                "contacts bounce, which is filtered out; they are worn when it grows", now,
                bounces - bounces_);
  bounces_ = bounces;
}

bool ControlThread::open() {
  if (!retry_.due(clock_.now()))
    return false;
  if (const auto opened = input_.open(); !opened) {
    faults_.add(Device::control_input, opened.error(), clock_.now());
    retry_.failure(clock_.now());
    return false;
  }
  retry_.success();
  return true;
}

} // namespace octascope::pipeline
