// Faults to come, read from a TOML file: what breaks, when, for how long, and how badly.
//
//   [[fault]]
//   device = "line_camera"     # line_camera | galvo_trigger | control_input | scope_camera |
//   display kind = "dropped_frames"    # see FaultKind for the kinds and their parameters at_s
//   = 2.0                 # since the schedule's start duration_s = 1.0           # how long it
//   lasts, or for frames and pulses count = 10                 # how many it hits; with both,
//   whichever ends first repeat_s = 20.0            # optional: again after so long, for ever
//
// The reader is strict: a parameter that means nothing to a fault's kind is refused.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::sim {

enum class FaultDevice : std::uint8_t {
  line_camera,
  galvo_trigger,
  control_input,
  scope_camera,
  display,
};

enum class FaultKind : std::uint8_t {
  unplug, // every device but the display: gone for duration_s, then back. The line camera may come
          // back as another one of its kind: comes_back_as

  // Line camera, frame by frame; `every`, `probability` and `seed` choose among the frames:
  dropped_frames,   // made by the hardware, never delivered: a gap in the sequence
  corrupted_frames, // flagged by the driver, its bytes scrambled
  wrong_size,       // size_share of the bytes are delivered
  late_frames,      // handed out late_ms late; its times stay true
  stuck_sequence,   // carries the sequence number of the frame before
  saturation,       // line_share of the lines at full scale

  // Galvo trigger, pulse by pulse, chosen as frames are:
  missed_pulses, // made by the driver, never seen by the scanner

  // Control input:
  bounce,       // each change of a contact bounces `bounces` times within bounce_ms
  stuck_switch, // the contact of `switch` stays closed (or open, with pressed = false)

  // Display:
  lost, // gone for duration_s, then back
};

inline constexpr std::array fault_devices{FaultDevice::line_camera, FaultDevice::galvo_trigger,
                                          FaultDevice::control_input, FaultDevice::scope_camera,
                                          FaultDevice::display};

std::string_view to_string(FaultDevice device);
std::string_view to_string(FaultKind kind);

// The kinds that a device can suffer.
std::span<const FaultKind> kinds_of(FaultDevice device);

struct ScriptedFault {
  FaultDevice device = FaultDevice::line_camera;
  FaultKind kind = FaultKind::unplug;
  hal::Duration at{};       // since the schedule's start
  hal::Duration duration{}; // 0: only `count` ends it
  std::uint64_t count = 0;  // 0: only `duration` ends it
  hal::Duration repeat{};   // 0: happens once; else longer than the duration

  // Which frames or pulses it hits: every n-th, and of those each with this probability.
  int every = 1;
  double probability = 1;
  std::uint64_t seed = 1;

  std::string comes_back_as;     // unplug of the line camera: its identity then; empty: as it was
  hal::Duration late_by{};       // late_frames
  double size_share = 0.5;       // wrong_size: 0 … 2 of a frame's bytes, but not 1
  double line_share = 0.25;      // saturation
  int switch_index = -1;         // bounce: −1 is all; stuck_switch
  bool stuck_pressed = true;     // stuck_switch
  int bounces = 6;               // bounce: extra openings and closings before a contact rests
  hal::Duration bounce_spread{}; // bounce: the time that they take together
};

// For people and reports: "line_camera unplug at 5 s for 2 s".
std::string describe(const ScriptedFault& fault);

struct FaultScript {
  std::vector<ScriptedFault> faults;

  static hal::Result<FaultScript> load(const std::filesystem::path& file);
  static hal::Result<FaultScript> parse(std::string_view text, const std::filesystem::path& name);
};

} // namespace octascope::sim
