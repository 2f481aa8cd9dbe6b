// A short look through the line camera: triggers some volumes and says what came.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/devices/devices.h"
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

// Line camera and trigger, open for one look after another. Bound to one thread.
class LineWatch {
public:
  // An Error where a device cannot be opened. Unless it `starts`, only the camera is, and looks have no
  // pulses.
  static hal::Result<std::unique_ptr<LineWatch>> open(const RunOptions& options,
                                                      const Configuration& configuration,
                                                      bool starts, hal::Clock& clock);
  ~LineWatch(); // neither device stays open
  LineWatch(const LineWatch&) = delete;
  LineWatch& operator=(const LineWatch&) = delete;

  // Frames that do not come are no Error, but counted.
  hal::Result<LiveLook> look(int pulses);

private:
  class Look;
  LineWatch(std::unique_ptr<Devices> devices, hal::Clock& clock)
      : devices_(std::move(devices)), clock_(clock) {}

  std::unique_ptr<Devices> devices_; // camera and trigger are made
  hal::Clock& clock_;
  std::string chosen_;
  std::string trigger_;
};

// One look, of a watch of its own.
hal::Result<LiveLook> look(const RunOptions& options, const Configuration& configuration,
                           int pulses, hal::Clock& clock);

} // namespace octascope::firmware_host
