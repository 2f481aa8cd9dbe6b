// Scripted faults, read from a TOML file: what fails, when, for how long, and how badly.
//
//   [[fault]]
//   device = "line_camera"
//   kind = "dropped_frames"  # one of scriptable_faults(), with its parameters
//   at_s = 2.0               # since the schedule's start
//   duration_s = 1.0         # how long it lasts; or, for frames and pulses:
//   count = 10               # how many it hits; with both, whichever ends first
//   repeat_s = 20.0          # optional: period of endless repetition
//
// Strict: parameters that do not apply to a fault's kind are refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/faults/fault.h"

namespace octascope::sim {

// Faults are scripted by the names under which the program reports them.
struct ScriptableFault {
  pipeline::Fault fault;
  std::string_view kind; // name in scripts; do not change
  bool counted;          // per frame or pulse: `every`, `probability`, `seed` apply
};

// All of them, by device. fault_script.cpp describes the effect of each beside its row.
std::span<const ScriptableFault> scriptable_faults();

// The fault of an unplugged device or a lost display.
constexpr pipeline::Fault gone(pipeline::Device device) {
  return fault_of(device, hal::ErrorCode::disconnected);
}

struct ScriptedFault {
  pipeline::Fault kind = gone(pipeline::Device::line_camera);
  hal::Duration at{};       // since the schedule's start
  hal::Duration duration{}; // 0: only `count` ends it
  std::uint64_t count = 0;  // 0: only `duration` ends it
  hal::Duration repeat{};   // 0: happens once; else must be longer than the duration

  // Which frames or pulses it hits: every n-th, and of those each with this probability.
  int every = 1;
  double probability = 1;
  std::uint64_t seed = 1;

  std::string comes_back_as;     // unplugged line camera: its new identity; empty: unchanged
  hal::Duration late_by{};       // late_frame
  double size_share = 0.5;       // wrong_size: 0 … 2 of a frame's bytes, but not 1
  double line_share = 0.25;      // saturation
  int switch_index = -1;         // bounce: −1 means all; stuck_switch
  bool stuck_pressed = true;     // stuck_switch
  int bounces = 6;               // bounce: extra openings and closings before the contact settles
  hal::Duration bounce_spread{}; // bounce: their total duration
};

// For display and reports: "line_camera unplug at 5 s for 2 s".
std::string describe(const ScriptedFault& fault);

struct FaultScript {
  std::vector<ScriptedFault> faults;

  static hal::Result<FaultScript> load(const std::filesystem::path& file);
  static hal::Result<FaultScript> parse(std::string_view text, const std::filesystem::path& name);
};

} // namespace octascope::sim
