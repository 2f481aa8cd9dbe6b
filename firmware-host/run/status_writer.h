// The only writer of the display's status.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "firmware-host/report/rate_meter.h"
#include "firmware-host/supervision/run_counters.h"
#include "hal/clock.h"
#include "pipeline/acquisition/rolling_volume.h"
#include "pipeline/volume/patient_eye.h"
#include "pipeline/volume/volume.h"
#include "ui/status/freshness.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

// What the host knows but the render loop does not.
struct HostStatus {
  std::array<ui::DeviceStatus, ui::Status::most_devices> devices;
  std::size_t device_count = 0;
  bool simulated = false;
  std::string source;         // what the volumes are; short
  bool replayed = false;      // the volumes are those of a recording
  pipeline::PatientEye whose; // as said for this very run, or for the recording
  std::string time_of_day;    // "14:05"
  ui::ConfigurationState configuration = ui::ConfigurationState::own;
  bool another_camera = false;
  ui::RecordingStatus recording;
  std::string notice; // empty: none
};

// Bound to the render thread.
class StatusWriter {
public:
  // All outlive it.
  StatusWriter(const ui::Legend& legend, const ui::Legend& key_legend, const ui::Timing& timing) {
    status_.legend = &legend;
    status_.key_legend = &key_legend;
    status_.timing = &timing;
  }

  const ui::Status& status() const { return status_; }
  RunRates rates() const {
    return {line_rate_.per_second(), volume_rate_.per_second(), shown_rate_.per_second(),
            frame_rate_.per_second()};
  }
  bool has_volume() const { return shown_.has_value(); }

  void tell(const HostStatus& host);

  void orient(const ui::ScanOrientation& orientation) { status_.orientation = orientation; }

  // Call when this volume enters the picture.
  void show(const pipeline::Volume& volume);

  // Sets the time of the next frame and the counts so far.
  void count(const RunCounters& counters, hal::TimePoint now);
  void judge(const ui::FreshnessLimits& limits, const std::optional<hal::TimePoint>& frozen_since);
  // Call behind count(). `seam` is empty where all of the picture is of one volume. Not `asked`:
  // whole volumes are.
  void roll(bool asked, bool possible, const std::optional<pipeline::RollingVolume::Seam>& seam);
  void reduce_quality(const std::optional<float>& share) { status_.reduced_quality = share; }
  void show_vessels(const ui::VesselStatus& vessels) { status_.vessels = vessels; }

private:
  ui::Status status_;
  std::optional<ui::ShownVolume> shown_;
  std::uint64_t passed_over_ = 0; // so far, and before it was shown
  std::uint64_t passed_over_before_ = 0;
  RateMeter volume_rate_, shown_rate_, line_rate_, frame_rate_;
};

} // namespace octascope::firmware_host
