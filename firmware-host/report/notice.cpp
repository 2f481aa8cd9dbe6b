#include "firmware-host/report/notice.h"

#include <algorithm>
#include <array>

namespace octascope::firmware_host {

namespace {

constexpr hal::Duration shown_for = std::chrono::seconds{2}; // after a fault last struck

struct DeviceNotice {
  std::string_view fault_device;  // as in the fault log
  std::string_view status_device; // as on the status bar
  std::string_view words;
};

// Gravest first. Not the display: nobody would see it.
constexpr std::array device_notices{
    DeviceNotice{"line_camera", "camera", "Line camera disconnected: reconnecting"},
    DeviceNotice{"galvo_trigger", "trigger", "Scanner trigger disconnected: reconnecting"},
    DeviceNotice{"control_input", "pedal", "Pedal disconnected: reconnecting"},
    DeviceNotice{"scope_camera", "scope", "Microscope camera disconnected: reconnecting"},
};

struct FaultNotice {
  std::string_view device;
  std::string_view kind;
  std::string_view words;
  hal::Duration lasts = shown_for;
};

// Gravest first; what concerns neither pictures nor hands is left to the report.
constexpr std::array fault_notices{
    FaultNotice{"line_camera", "stuck_thread", "Line camera does not answer: its driver hangs"},
    FaultNotice{"pipeline", "stuck_thread", "Reconstruction hangs: restart the system"},
    FaultNotice{"control_input", "stuck_thread", "Pedal does not answer: its driver hangs"},
    FaultNotice{"scope_camera", "stuck_thread", "Microscope camera does not answer"},
    FaultNotice{"pipeline", "overrun", "Reconstruction is too slow: volumes are lost"},
    FaultNotice{"pipeline", "late_tick", "The computer is busy: volumes are lost"},
    FaultNotice{"line_camera", "silent", "Line camera is silent: is the scanner on?"},
    FaultNotice{"galvo_trigger", "missed_pulse", "The scanner misses pulses: volumes are lost"},
    FaultNotice{"galvo_trigger", "unanswered_pulse", "The scanner does not answer: is it on?"},
    FaultNotice{"line_camera", "overflow", "Reconstruction is too slow: B-scans are missing"},
    FaultNotice{"line_camera", "dropped_frames", "Line camera loses frames: B-scans are missing"},
    FaultNotice{"line_camera", "corrupted_frame",
                "Line camera sends broken frames: B-scans are missing"},
    FaultNotice{"line_camera", "wrong_size",
                "Line camera sends frames of a wrong size: B-scans are missing"},
    FaultNotice{"line_camera", "late_frame", "Line camera is late: B-scans are missing"},
    FaultNotice{"line_camera", "unplaced_frame", "Line camera is out of step: B-scans are missing"},
    FaultNotice{"line_camera", "doubled_frame", "Line camera sends B-scans twice"},
    FaultNotice{"line_camera", "saturation", "Too much light: lines are saturated"},
    FaultNotice{"picture", "upper_border", "Top may be upside down: refocus"},
    FaultNotice{"recording", "unreadable_volume", "The recording is damaged: volumes are missing"},
    FaultNotice{"line_camera", "another_camera", "Depths unsure: change calibration",
                std::chrono::seconds{20}}, // the badge stays
    FaultNotice{"host", "throttled", "The computer is too hot: it slows itself down"},
    FaultNotice{"host", "low_memory", "The computer is short of memory"},
    FaultNotice{"host", "disk_full", "The disk is full: pictures may be lost"},
    FaultNotice{"recording", "disk_full", "The disk is full: the recording ended",
                std::chrono::seconds{20}},
    FaultNotice{"recording", "not_kept", "The recording ended: its disk fails",
                std::chrono::seconds{20}},
    FaultNotice{"recording", "not_finished", "The recording was not closed: its disk fails",
                std::chrono::seconds{20}},
    FaultNotice{"recording", "not_begun", "The recording cannot be begun: look at its folder",
                std::chrono::seconds{20}},
    FaultNotice{"line_camera", "came_late", "A line camera is there: start octascope again",
                std::chrono::hours{24}},
    FaultNotice{"host", "picture_not_kept", "The picture was not kept"},
    FaultNotice{"control_input", "stuck_switch", "A pedal switch stays down: is it stuck?"},
    FaultNotice{"host", "restarted_after_crash",
                "The program crashed and was restarted: check the settings",
                std::chrono::minutes{1}},
};

bool is_away(hal::DeviceState state) {
  return state == hal::DeviceState::absent || state == hal::DeviceState::failed;
}

} // namespace

std::string_view compose_notice(std::span<const pipeline::FaultRecord> faults,
                                std::span<const ui::DeviceStatus> devices, hal::TimePoint now) {
  // Without a fault, a device that is not open has not been opened yet.
  for (const DeviceNotice& notice : device_notices) {
    const bool faulty = std::ranges::any_of(
        faults, [&](const auto& fault) { return fault.device == notice.fault_device; });
    const bool away = std::ranges::any_of(devices, [&](const ui::DeviceStatus& device) {
      return device.name == notice.status_device && is_away(device.state);
    });
    if (faulty && away)
      return notice.words;
  }
  for (const FaultNotice& notice : fault_notices) {
    if (std::ranges::any_of(faults, [&](const pipeline::FaultRecord& fault) {
          return fault.device == notice.device && fault.kind == notice.kind &&
                 now - fault.last <= notice.lasts;
        }))
      return notice.words;
  }
  return {};
}

} // namespace octascope::firmware_host
