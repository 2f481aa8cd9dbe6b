// The control thread: reads pedal and knob events and queues them for the render thread.
#pragma once

#include <optional>

#include "hal/clock.h"
#include "hal/control_input.h"
#include "pipeline/controls/held_switches.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/event_queue.h"
#include "pipeline/threads/retry_delay.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

// The device may disconnect and return at any time; it is reopened with a back-off.
class ControlThread {
public:
  // All references outlive this; `news` is posted when events were queued.
  ControlThread(hal::ControlInput& input, hal::Clock& clock, FaultLog& faults, Wakeup& news);

  void start(const ThreadSetup& setup);
  void stop() { thread_.stop(); }

  // One consumer thread. The oldest event, if any.
  std::optional<hal::ControlEvent> take() { return queue_.pop(); }

private:
  void run();
  bool open();
  void receive(const hal::ControlEvent& event);
  void look_for_bad_contacts();

  hal::ControlInput& input_;
  hal::Clock& clock_;
  FaultLog& faults_;
  Wakeup& news_;
  EventQueue<hal::ControlEvent, 256> queue_;
  RetryDelay retry_;
  HeldSwitches held_;
  std::uint64_t bounces_ = 0; // reported so far
  RoleThread thread_;
};

} // namespace octascope::pipeline
