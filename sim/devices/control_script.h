// What a foot and a hand will do, read from a TOML file.
//
//   repeat_s = 10.0        # optional: play the whole again after so long, for ever
//
//   [[event]]
//   time_s = 1.0           # since the input was first opened; events may stand in any order
//   switch = 0             # exactly one of: switch = 0 … 2 (left, centre, right)
//   value = 1              #   1 pressed, 0 released
//
//   [[event]]
//   time_s = 1.5
//   knob = 0               # knob = 0: value is the detents turned, right is positive
//   value = -3
//
//   [[event]]
//   time_s = 2.0
//   axis = 4               # axis = 0 … 5: value −1000 … 1000
//   value = 250
//
// Strict, as all configuration: unknown keys and values out of range are refused.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "hal/control_input.h"
#include "hal/result.h"

namespace octascope::sim {

// The number of controls of the simulated device.
inline constexpr int switch_count = 3;
inline constexpr int knob_count = 1;
inline constexpr int axis_count = 6;

// Whether the simulated device has such a control, and the value is in its range.
bool is_plausible(const hal::ControlEvent& event);

struct ScriptedControl {
  hal::Duration at{}; // since time zero
  hal::ControlKind kind = hal::ControlKind::pedal_switch;
  std::uint8_t index = 0;
  std::int32_t value = 0;
};

struct ControlScript {
  std::vector<ScriptedControl> events; // ordered by time
  hal::Duration repeat{};              // 0: played once; else longer than the last event's time

  static hal::Result<ControlScript> load(const std::filesystem::path& file);
  static hal::Result<ControlScript> parse(std::string_view text, const std::filesystem::path& name);
};

// A position in a script that is being played. Pure; borrows the script.
class ControlScriptCursor {
public:
  explicit ControlScriptCursor(const ControlScript& script) : script_(script) {}

  // When the next event is due, since time zero; empty at the script's end.
  std::optional<hal::Duration> next_time() const;

  // Only if there is a next event.
  const ScriptedControl& take();

private:
  const ControlScript& script_;
  std::size_t next_ = 0;
  hal::Duration round_began_{};
};

} // namespace octascope::sim
