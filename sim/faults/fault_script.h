// Faults to come, read from a TOML file: what breaks, when, for how long, and how badly.
//
//   [[fault]]
//   device = "line_camera"
//   kind = "dropped_frames"  # one of scriptable_faults(), with its parameters
//   at_s = 2.0               # since the schedule's start
//   duration_s = 1.0         # how long it lasts; or, for frames and pulses:
//   count = 10               # how many it hits; with both, whichever ends first
//   repeat_s = 20.0          # optional: again after so long, for ever
//
// The reader is strict: a parameter that means nothing to a fault's kind is refused.
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

// A fault is scripted under the name with which the program reports it.
struct ScriptableFault {
  pipeline::Fault fault;
  std::string_view kind; // name in scripts; must not change
  bool counted;          // counted in frames or pulses, chosen by `every`, `probability`, `seed`
};

// All scriptable faults, by device. Their effects are described beside their rows in
// fault_script.cpp.
std::span<const ScriptableFault> scriptable_faults();

// The fault of an unplugged device or a lost display.
constexpr pipeline::Fault gone(pipeline::Device device) {
  return fault_of(device, hal::ErrorCode::disconnected);
}

struct ScriptedFault {
  pipeline::Fault kind = gone(pipeline::Device::line_camera);
  hal::Duration at{};       // since the schedule's start
  hal::Duration duration{}; // 0: ended by `count` only
  std::uint64_t count = 0;  // 0: ended by `duration` only
  hal::Duration repeat{};   // 0: happens once; else longer than the duration

  // Which frames or pulses it hits: every n-th, each of those with this probability.
  int every = 1;
  double probability = 1;
  std::uint64_t seed = 1;

  std::string comes_back_as;     // unplugged line camera: its identity when it returns; empty:
                                 // unchanged
  hal::Duration late_by{};       // late_frame
  double size_share = 0.5;       // wrong_size: fraction of a frame's bytes, 0 … 2, not 1
  double line_share = 0.25;      // saturation
  int switch_index = -1;         // stuck_switch, and bounce, where −1 is all
  bool stuck_pressed = true;     // stuck_switch
  int bounces = 6;               // bounce: extra openings and closings before the contact settles
  hal::Duration bounce_spread{}; // bounce: their total duration
};

// For people and reports: "line_camera unplug at 5 s for 2 s".
std::string describe(const ScriptedFault& fault);

struct FaultScript {
  std::vector<ScriptedFault> faults;

  static hal::Result<FaultScript> load(const std::filesystem::path& file);
  static hal::Result<FaultScript> parse(std::string_view text, const std::filesystem::path& name);
};

} // namespace octascope::sim
