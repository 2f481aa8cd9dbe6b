// Simulated pedal and knob: three switches, a knob and a 6-axis puck, controlled by a script and by
// injected events (from the host, for keys).
//
// Scripted moves and faults happen at their own times, however late read() is called: its results
// are a function of the script, the schedule and the injected events. Switches pass through a
// contact that may bounce or stick, and through the debouncer, so a press is reported 5 ms later.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/control_input.h"
#include "sim/devices/bouncing_contact.h"
#include "sim/devices/control_queue.h"
#include "sim/devices/control_script.h"
#include "sim/faults/fault_probe.h"

namespace octascope::sim {

class SimControlInput final : public hal::ControlInput {
public:
  // The clock and the schedule must outlive the input; `faults` may be null. The script's time zero
  // is the first open(); while the device is unplugged the script continues, unseen.
  explicit SimControlInput(hal::Clock& clock, ControlScript script = {},
                           const FaultSchedule* faults = nullptr);

  // Any thread, any state; lock-free. Moves a switch, knob or axis as if by hand, at event.time or
  // when it is noticed, within 1 ms. Returns false without effect if the device has no such control
  // or value, or if more than ControlQueue::capacity events wait to be read. Events injected while
  // the device is not open are lost, like a press on an unplugged pedal.
  bool inject(const hal::ControlEvent& event);

private:
  std::string_view do_backend() const override { return "sim"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open() override;
  hal::Result<std::size_t> do_read(std::span<hal::ControlEvent> events,
                                   hal::Duration timeout) override;
  std::uint64_t do_bounces() const override;
  void do_close() override;

  void play_to(hal::TimePoint now);
  bool play_timeline(hal::TimePoint now);
  hal::TimePoint next_moment() const;
  void play_moment(hal::TimePoint t);
  void play_script(hal::TimePoint t);
  void play_injected(hal::TimePoint t);
  void look_for_injected(hal::TimePoint now);
  void update_stuck_switches(hal::TimePoint t);
  void move(hal::TimePoint t, hal::ControlKind what, std::uint8_t index, std::int32_t value);
  void pull_out(hal::TimePoint t);
  void report(const hal::ControlEvent& event);
  bool has_room() const { return reported_ + most_reports_at_once <= outbox_.size(); }
  std::size_t fetch(std::span<hal::ControlEvent> events);

  // One moment can report every switch, a scripted and an injected event; and, if the device is
  // then unplugged, every switch and axis once more.
  static constexpr std::size_t most_reports_at_once = switch_count + 2 + switch_count + axis_count;

  hal::Clock& clock_;
  const ControlScript script_;
  ControlScriptCursor cursor_;
  FaultProbe probe_;
  ControlQueue injected_;
  std::optional<hal::ControlEvent> next_injected_; // already taken from the queue

  std::optional<hal::TimePoint> zero_; // of the script
  hal::TimePoint played_to_;
  hal::TimePoint last_reported_;
  std::array<BouncingContact, switch_count> contacts_;
  std::array<std::int32_t, axis_count> axes_{}; // as reported
  bool pulled_out_ = false;

  std::array<hal::ControlEvent, 64> outbox_{}; // reported but not yet read; a ring
  std::size_t oldest_ = 0;
  std::size_t reported_ = 0;
};

} // namespace octascope::sim
