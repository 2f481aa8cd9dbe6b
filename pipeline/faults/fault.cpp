#include "pipeline/faults/fault.h"

#include <array>

namespace octascope::pipeline {

namespace {

using namespace std::chrono_literals;

constexpr std::array device_table{
    DeviceFacts{Device::line_camera, "line_camera", "camera",
                "Line camera disconnected: reconnecting",
                "Line camera may not be opened: ask octascope doctor"},
    DeviceFacts{Device::galvo_trigger, "galvo_trigger", "trigger",
                "Scanner trigger disconnected: reconnecting",
                "Scanner trigger may not be opened: ask octascope doctor"},
    DeviceFacts{Device::control_input, "control_input", "pedal", "Pedal disconnected: reconnecting",
                "Pedal may not be opened: ask octascope doctor"},
    DeviceFacts{Device::scope_camera, "scope_camera", "scope",
                "Microscope camera disconnected: reconnecting",
                "Microscope camera may not be opened: ask octascope doctor"},
    DeviceFacts{Device::display, "display"}, // nobody would see it
    DeviceFacts{Device::pipeline, "pipeline"},
    DeviceFacts{Device::picture, "picture"},
    DeviceFacts{Device::recording, "recording"},
    DeviceFacts{Device::vessels, "vessels"},
    DeviceFacts{Device::keyboard, "keyboard"},
    DeviceFacts{Device::host, "host"},
};

constexpr std::array fault_table{
    FaultFacts{Fault::line_camera_stuck_thread, Device::line_camera, "stuck_thread",
               "Line camera does not answer: its driver hangs"},
    FaultFacts{Fault::pipeline_stuck_thread, Device::pipeline, "stuck_thread",
               "Reconstruction hangs: restart the system"},
    FaultFacts{Fault::control_input_stuck_thread, Device::control_input, "stuck_thread",
               "Pedal does not answer: its driver hangs"},
    FaultFacts{Fault::scope_camera_stuck_thread, Device::scope_camera, "stuck_thread",
               "Microscope camera does not answer"},
    FaultFacts{Fault::ran_away, Device::pipeline, "ran_away",
               "The program misbehaves: start it again", 20s},
    FaultFacts{Fault::overrun, Device::pipeline, "overrun",
               "Reconstruction is too slow: volumes are lost"},
    FaultFacts{Fault::late_tick, Device::pipeline, "late_tick",
               "The computer is busy: volumes are lost"},
    FaultFacts{Fault::silent, Device::line_camera, "silent",
               "Line camera is silent: is the scanner on?"},
    FaultFacts{Fault::missed_pulse, Device::galvo_trigger, "missed_pulse",
               "The scanner misses pulses: volumes are lost"},
    FaultFacts{Fault::unanswered_pulse, Device::galvo_trigger, "unanswered_pulse",
               "The scanner does not answer: is it on?"},
    FaultFacts{Fault::frame_overflow, Device::line_camera, "overflow",
               "Reconstruction is too slow: B-scans are missing"},
    FaultFacts{Fault::dropped_frames, Device::line_camera, "dropped_frames",
               "Line camera loses frames: B-scans are missing"},
    FaultFacts{Fault::corrupted_frame, Device::line_camera, "corrupted_frame",
               "Line camera sends broken frames: B-scans are missing"},
    FaultFacts{Fault::wrong_size, Device::line_camera, "wrong_size",
               "Line camera sends frames of a wrong size: B-scans are missing"},
    FaultFacts{Fault::late_frame, Device::line_camera, "late_frame",
               "Line camera is late: B-scans are missing"},
    FaultFacts{Fault::unplaced_frame, Device::line_camera, "unplaced_frame",
               "Line camera is out of step: B-scans are missing"},
    FaultFacts{Fault::doubled_frame, Device::line_camera, "doubled_frame",
               "Line camera sends B-scans twice"},
    FaultFacts{Fault::saturation, Device::line_camera, "saturation",
               "Too much light: lines are saturated"},
    FaultFacts{Fault::upper_border, Device::picture, "upper_border",
               "Top may be upside down: refocus"},
    FaultFacts{Fault::unreadable_volume, Device::recording, "unreadable_volume",
               "The recording is damaged: volumes are missing"},
    FaultFacts{Fault::unusable_stamps, Device::line_camera, "unusable_stamps",
               "Line camera's clock is wrong: B-scans may be misplaced", 20s},
    FaultFacts{Fault::another_camera, Device::line_camera, "another_camera",
               "Depths unsure: change calibration", 20s}, // the badge stays
    FaultFacts{Fault::throttled, Device::host, "throttled",
               "The computer is too hot: it slows itself down"},
    FaultFacts{Fault::low_memory, Device::host, "low_memory", "The computer is short of memory"},
    FaultFacts{Fault::disk_full, Device::host, "disk_full",
               "The disk is full: pictures may be lost"},
    FaultFacts{Fault::recording_disk_full, Device::recording, "disk_full",
               "The disk is full: the recording ended", 20s},
    FaultFacts{Fault::recording_gone, Device::recording, "gone",
               "The recording ended: its file was removed", 20s},
    FaultFacts{Fault::recording_not_kept, Device::recording, "not_kept",
               "The recording ended: its disk fails", 20s},
    FaultFacts{Fault::recording_not_finished, Device::recording, "not_finished",
               "The recording was not closed: its disk fails", 20s},
    FaultFacts{Fault::recording_not_begun, Device::recording, "not_begun",
               "The recording cannot be begun: look at its folder", 20s},
    FaultFacts{Fault::recording_waits, Device::recording, "waiting",
               "The recording waits for its disk", 20s},
    FaultFacts{Fault::came_late, Device::line_camera, "came_late",
               "A line camera is there: start octascope again", 24h},
    FaultFacts{Fault::picture_not_kept, Device::host, "picture_not_kept",
               "The picture was not kept"},
    FaultFacts{Fault::stuck_switch, Device::control_input, "stuck_switch",
               "A pedal switch stays down: is it stuck?"},
    FaultFacts{Fault::restarted_after_crash, Device::host, "restarted_after_crash",
               "The program crashed and was restarted: check the settings", 1min},

    FaultFacts{Fault::stuck_sequence, Device::line_camera, "stuck_sequence"},
    FaultFacts{Fault::control_overflow, Device::control_input, "overflow"},
    FaultFacts{Fault::bounce, Device::control_input, "bounce"},
    FaultFacts{Fault::phase_beyond_turn_around, Device::galvo_trigger, "phase_beyond_turn_around"},
    FaultFacts{Fault::vessels_not_shown, Device::vessels, "not_shown"},
    FaultFacts{Fault::flow_not_shown, Device::display, "flow_not_shown"},
    FaultFacts{Fault::registration_not_kept, Device::vessels, "registration_not_kept"},
    FaultFacts{Fault::keyboard_not_opened, Device::keyboard, "not_opened"},
    FaultFacts{Fault::clock_jump, Device::host, "clock_jump"},
    FaultFacts{Fault::memory_not_locked, Device::host, "memory_not_locked"},
    FaultFacts{Fault::no_realtime, Device::host, "no_realtime"},
    FaultFacts{Fault::not_pinned, Device::host, "not_pinned"},
    FaultFacts{Fault::no_status_socket, Device::host, "no_status_socket"},
    FaultFacts{Fault::metrics_not_written, Device::host, "metrics_not_written"},
    FaultFacts{Fault::configuration_refused, Device::host, "configuration_refused"},
    FaultFacts{Fault::configuration_not_kept, Device::host, "configuration_not_kept"},
    FaultFacts{Fault::settings_broken, Device::host, "settings_broken"},
    FaultFacts{Fault::settings_not_kept, Device::host, "settings_not_kept"},
};

// Whether `rows` has one row for each of the enumerators, in their order.
template <class Row, class Named>
constexpr bool is_complete(const auto& rows, Named Row::*named, std::size_t count) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].*named != static_cast<Named>(i))
      return false;
  return rows.size() == count;
}

static_assert(is_complete(device_table, &DeviceFacts::device, device_count),
              "every Device needs its row, in the order of the enumeration");
static_assert(is_complete(fault_table, &FaultFacts::fault, named_fault_count),
              "every Fault needs its row, in the order of the enumeration");
static_assert(fault_count <= 256, "a Fault is one byte");

} // namespace

std::string_view FaultFacts::device_key() const {
  return facts_of(device).key;
}

const DeviceFacts& facts_of(Device device) {
  return device_table.at(static_cast<std::size_t>(device));
}

FaultFacts facts_of(Fault fault) {
  if (index_of(fault) < named_fault_count)
    return fault_table[index_of(fault)];
  const std::size_t error = index_of(fault) - named_fault_count;
  return {fault, static_cast<Device>(error / error_code_count),
          to_string(static_cast<hal::ErrorCode>(error % error_code_count))};
}

} // namespace octascope::pipeline
