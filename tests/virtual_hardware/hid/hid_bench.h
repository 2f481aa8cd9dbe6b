// Controls through the kernel's own HID and input drivers, and what they say.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/linux/hid/controls/hid_controls.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/virtual_hardware/support/virtual_knob.h"
#include "tests/virtual_hardware/support/virtual_pedal.h"

namespace octascope::tests {

// Why the kernel cannot make these devices; empty when it can.
std::string virtual_controls_missing();

std::unique_ptr<VirtualPedal> plug_in(const VirtualPedalKind& kind);
std::unique_ptr<VirtualKnob> plug_in_knob();

// Until udevd has told of everything that was plugged in: what is told later is looked into, which
// allocates.
void await_udev();

// What happened, without when.
struct Move {
  hal::ControlKind kind;
  int index;
  int value;
  bool operator==(const Move&) const = default;
};
inline void PrintTo(const Move& move, std::ostream* out) {
  *out << (move.kind == hal::ControlKind::pedal_switch ? "switch "
           : move.kind == hal::ControlKind::knob       ? "knob "
                                                       : "axis ")
       << move.index << ": " << move.value;
}
using Moves = std::vector<Move>;

inline Move pressed(int index) {
  return {hal::ControlKind::pedal_switch, index, 1};
}
inline Move released(int index) {
  return {hal::ControlKind::pedal_switch, index, 0};
}
inline Move turned(int detents) {
  return {hal::ControlKind::knob, 0, detents};
}
inline Move pushed(int axis, int value) {
  return {hal::ControlKind::axis, axis, value};
}

// Skips where the kernel has neither uhid nor uinput.
class HidTest : public testing::Test {
protected:
  void SetUp() override;

  // Everything until nothing has happened for 30 ms.
  Moves read_all() { return read_all(controls_); }
  static Moves read_all(hal::ControlInput& input);

  hal::linux_backend::MonotonicClock clock_;
  hal::linux_backend::HidControls controls_{clock_};
};

} // namespace octascope::tests
