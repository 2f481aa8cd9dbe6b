// How the beam moves, and so how a stream of camera frames becomes a volume.
#pragma once

#include "hal/clock.h"
#include "hal/line_camera.h"
#include "hal/result.h"
#include "pipeline/volume.h"

namespace octascope::pipeline {

// Defaults are those of the source paper: 215 kHz, 300 kept A-scans and 79 fly-back lines a
// B-scan, 80 B-scans: a volume every 141 ms.
struct ScanPlan {
  static constexpr int pause_divisor = 500; // the pause is 0.2 % of the sweeps

  int samples = 1024;      // per line; depths are half of it, times the zero-padding
  int zero_padding = 1;    // the calibration's: depths are so many times more and closer
  int a_scans = 300;       // kept lines per B-scan
  int fly_back_lines = 79; // at the end of each frame, recorded and not converted
  int b_scans = 80;
  double line_rate_hz = 215e3;
  double depth_spacing_um = 3.5;
  double a_spacing_um = 10;
  double b_spacing_um = 37.5;

  int lines_per_frame() const { return a_scans + fly_back_lines; }
  hal::Duration line_period() const { return hal::from_seconds(1.0 / line_rate_hz); }
  hal::Duration b_scan_period() const {
    return hal::from_seconds(lines_per_frame() / line_rate_hz);
  }
  hal::Duration sweep_duration() const {
    return hal::from_seconds(static_cast<double>(lines_per_frame()) * b_scans / line_rate_hz);
  }
  // From one trigger pulse to the next: a little more than the sweeps need, so that a scanner
  // that started late once catches up.
  hal::Duration tick_period() const { return sweep_duration() + sweep_duration() / pause_divisor; }
  VolumeGeometry geometry() const {
    return {samples * zero_padding / 2,      a_scans,      b_scans,
            depth_spacing_um / zero_padding, a_spacing_um, b_spacing_um};
  }

  // Counts within reason and positive rates and spacings; the message names the first that is not,
  // with what was found and expected.
  hal::Result<> validate() const;

  bool operator==(const ScanPlan&) const = default;
};

} // namespace octascope::pipeline
