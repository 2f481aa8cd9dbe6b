// All faults: the device concerned, the severity and the text shown to users.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::pipeline {

// What a fault concerns: first the devices, in the order in which an image needs them, then other
// parts that are reported in the same way.
enum class Device : std::uint8_t {
  line_camera,
  galvo_trigger,
  control_input,
  scope_camera,
  display,
  pipeline, // from frames to volumes
  picture,  // the contents of the volume
  recording,
  vessels,
  keyboard,
  host, // the computer, and the program's files on it
};

inline constexpr std::size_t device_count = static_cast<std::size_t>(Device::host) + 1;

struct DeviceFacts {
  Device device;
  std::string_view key;         // in reports, journal, metrics and fault scripts: stable
  std::string_view name = key;  // on the status bar and in `octascope status`: stable
  std::string_view away = {};   // the notice while it is disconnected; empty: none
  std::string_view denied = {}; // while it is there, and may not be opened
};

// Most severe first: of several faults, the display shows the one listed first.
enum class Fault : std::uint8_t {
  line_camera_stuck_thread,
  pipeline_stuck_thread,
  control_input_stuck_thread,
  scope_camera_stuck_thread,
  ran_away,
  overrun,
  late_tick,
  silent,
  missed_pulse,
  unanswered_pulse,
  frame_overflow,
  dropped_frames,
  corrupted_frame,
  wrong_size,
  late_frame,
  unplaced_frame,
  doubled_frame,
  saturation,
  upper_border,
  unreadable_volume,
  unusable_stamps,
  another_camera,
  throttled,
  low_memory,
  disk_full,
  recording_disk_full,
  recording_gone,
  recording_not_kept,
  recording_not_finished,
  recording_not_begun,
  recording_waits,
  came_late,
  picture_not_kept,
  stuck_switch,
  restarted_after_crash,

  // Only in the report: these affect neither the image nor the controls.
  stuck_sequence,
  control_overflow,
  bounce,
  phase_beyond_turn_around,
  vessels_not_shown,
  flow_not_shown,
  registration_not_kept,
  keyboard_not_opened,
  clock_jump,
  memory_not_locked,
  no_realtime,
  not_pinned,
  no_status_socket,
  metrics_not_written,
  configuration_refused,
  configuration_not_kept,
  settings_broken,
  settings_not_kept,

  device_errors, // first of the device errors, which have no names of their own
};

inline constexpr std::size_t named_fault_count = static_cast<std::size_t>(Fault::device_errors);
inline constexpr std::size_t error_code_count =
    static_cast<std::size_t>(hal::ErrorCode::system) + 1;
inline constexpr std::size_t fault_count = named_fault_count + device_count * error_code_count;

constexpr std::size_t index_of(Fault fault) {
  return static_cast<std::size_t>(fault);
}

// The fault for an error returned by a device: each device has one for each hal::ErrorCode.
constexpr Fault fault_of(Device device, hal::ErrorCode code) {
  return static_cast<Fault>(named_fault_count +
                            static_cast<std::size_t>(device) * error_code_count +
                            static_cast<std::size_t>(code));
}

struct FaultFacts {
  Fault fault;
  Device device;
  std::string_view key;         // "kind" in reports and metrics: stable
  std::string_view notice = {}; // text on the display; empty: only in the report
  hal::Duration shown_for = std::chrono::seconds{2}; // after it last occurred

  std::string_view device_key() const; // "device" in reports and metrics
};

// Looked up in the tables of all devices and faults. Every string is a literal.
const DeviceFacts& facts_of(Device device);
FaultFacts facts_of(Fault fault);

} // namespace octascope::pipeline
