// A short look through the line camera: triggers some volumes and says what came.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/clock.h"
#include "hal/line_camera.h"
#include "hal/result.h"
#include "pipeline/calibration_finder/spectrum_quality.h"
#include "pipeline/reconstruction/spectrum_format.h"

namespace octascope::firmware_host {

struct LiveLook {
  std::string chosen;  // the camera: backend, and why it is this one
  std::string trigger; // likewise
  std::string camera;  // LineCamera::identity(); empty: unknown
  pipeline::SpectrumFormat format;
  hal::CameraControls controls;
  int pulses = 0;
  int answered = 0; // pulses after which a frame came
  std::uint64_t frames = 0;
  std::uint64_t expected_frames = 0;
  std::uint64_t lost_frames = 0;        // gaps of the camera's own counter
  std::uint64_t broken_frames = 0;      // the driver flagged an error, or another size
  std::uint64_t unanswered_on_sync = 0; // pulses, where there is a sync line
  double line_rate_hz = 0;              // by the frames' times; 0: fewer than two came
  std::vector<double> mean_line;        // of the lines that were looked at; empty: none came
  std::vector<double> one_line;         // the last
  std::vector<double> highest_line;     // of each pixel the highest count
  pipeline::SpectrumQuality quality;    // likewise
};

// Opens camera and trigger, closes them again. No pulses: only opens the camera. An Error where a
// device cannot be opened; frames that do not come are no Error, but counted.
hal::Result<LiveLook> look(const RunOptions& options, const Configuration& configuration,
                           int pulses, hal::Clock& clock);

} // namespace octascope::firmware_host
