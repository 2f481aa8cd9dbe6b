// How the beam moves, and thus how camera frames form a volume.
//
// A sweep is one pass of the beam along the fast axis: one camera frame. Each B-scan is swept
// `repeats` times in succession. One-directional sweeps all run from the first A-scan to
// the last and end with the fly-back. Bidirectional ones run there and back by turns: every second
// sweep of a volume runs backwards, nothing flies back, and a few lines remain in which the mirror
// turns.
#pragma once

#include <optional>

#include "hal/clock.h"
#include "hal/line_camera.h"
#include "hal/result.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// Defaults are those of the source paper: 215 kHz, 300 kept A-scans and 79 fly-back lines a
// B-scan, 80 B-scans: a volume every 141 ms.
struct ScanPlan {
  static constexpr int pause_divisor = 500; // the pause is 0.2 % of the sweeps
  static constexpr int most_repeats = 4;

  int samples = 1024;      // per line; depths are half of it, times the zero-padding
  int zero_padding = 1;    // the calibration's: depths are so many times more and closer
  int a_scans = 300;       // kept lines per sweep
  int fly_back_lines = 79; // one-directional: at the end of each frame, recorded, not converted
  int b_scans = 80;
  double line_rate_hz = 215e3;
  double depth_spacing_um = 3.5;
  double a_spacing_um = 10;
  double b_spacing_um = 37.5;
  std::optional<double> refractive_index{}; // in which depth_spacing_um holds; empty: unknown
  AssumedSpacings assumed_spacings{};

  bool bidirectional = false;
  int turn_around_lines = 8; // bidirectional: at the end of each frame; best no fewer than the lag
  // Bidirectional: by how many A-scans the mirror lags behind its command. With find_scan_lag
  // this is only where the search begins.
  double scan_lag_a_scans = 0;
  bool find_scan_lag = true;
  int repeats = 1; // sweeps of each B-scan; the volume rate falls by as much

  int lines_per_frame() const {
    return a_scans + (bidirectional ? turn_around_lines : fly_back_lines);
  }
  // Of each frame, the first. The lag decides which lines of a bidirectional sweep are kept.
  int converted_lines() const { return bidirectional ? lines_per_frame() : a_scans; }

  int sweeps() const { return b_scans * repeats; } // of a volume
  int b_scan_of(int sweep) const { return sweep / repeats; }
  bool runs_backwards(int sweep) const { return bidirectional && sweep % 2 != 0; }

  hal::Duration line_period() const { return hal::from_seconds(1.0 / line_rate_hz); }
  hal::Duration frame_period() const { return hal::from_seconds(lines_per_frame() / line_rate_hz); }
  // Of all sweeps of a volume.
  hal::Duration sweep_duration() const {
    return hal::from_seconds(static_cast<double>(lines_per_frame()) * sweeps() / line_rate_hz);
  }
  // From one trigger pulse to the next: a little more than the sweeps need, so that a scanner
  // that started late once catches up.
  hal::Duration tick_period() const { return sweep_duration() + sweep_duration() / pause_divisor; }
  double volumes_per_s() const { return 1 / hal::to_seconds(tick_period()); }
  VolumeGeometry geometry() const {
    return {samples * zero_padding / 2,
            a_scans,
            b_scans,
            depth_spacing_um / zero_padding,
            a_spacing_um,
            b_spacing_um,
            refractive_index,
            assumed_spacings};
  }

  // Counts within reason and positive rates and spacings; the message names the first that is not,
  // with what was found and expected.
  hal::Result<> validate() const;

  bool operator==(const ScanPlan&) const = default;
};

} // namespace octascope::pipeline
