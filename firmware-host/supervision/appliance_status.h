// What `octascope status` and the metrics file report about a running appliance.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/supervision/run_counters.h"
#include "firmware-host/supervision/thread_watch.h"
#include "hal/clock.h"
#include "hal/device.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/duration_statistics.h"
#include "ui/status/freshness.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

// Which camera the calibration is of, and which one is open.
struct CalibrationAccount {
  std::string camera;              // named by the calibration; empty: none
  std::string line_camera;         // opened last; empty: it does not identify itself
  std::string verdict = "unknown"; // CameraVerdict's name
};

// What the render thread knows; plain data, passed once a second.
struct PictureStatus {
  struct DeviceLine {
    std::string name;    // "camera", "trigger" …
    std::string backend; // "v4l2", "sim" …
    hal::DeviceState state = hal::DeviceState::absent;
  };

  hal::TimePoint told;
  bool simulated = false;
  std::string source; // what the spectra are
  std::vector<DeviceLine> devices{};
  ui::Freshness freshness;
  RunCounters counters;
  std::string notice; // on the screen now; empty: none
  CalibrationAccount calibration{};
};

// The render thread's status and what is known besides.
struct ApplianceStatus {
  hal::TimePoint now;
  double uptime_s = 0;
  std::string configuration; // the file in use; empty: the defaults
  ui::ConfigurationState configuration_state = ui::ConfigurationState::own;
  std::optional<PictureStatus> picture; // empty: nothing was shown yet
  std::vector<ThreadState> threads;
  std::vector<pipeline::FaultRecord> faults;
  std::optional<std::uint64_t> resident_bytes;
  std::optional<double> temperature_c; // of the hottest zone
};

std::string_view to_string(ui::Liveness liveness);
std::string_view to_string(ui::ConfigurationState state);

// One JSON object on one line. Its keys are a contract: tools read them.
std::string to_json(const ApplianceStatus& status);

// Prometheus' text format, version 0.0.4.
std::string to_metrics(const ApplianceStatus& status);

// One line, for systemd and for a report of a crash.
std::string to_line(const PictureStatus& status);

} // namespace octascope::firmware_host
