// Whether the open line camera is the one that the calibration was made with.
//
// Spectrometers of one kind have equally many samples, so another one's calibration fits but blurs,
// and depths are wrong by some per cent without any visible sign. The picture is therefore marked.
// It is not refused: an interrupted picture is the greater hazard.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "hal/clock.h"
#include "hal/line_camera.h"
#include "pipeline/faults/fault_log.h"

namespace octascope::firmware_host {

enum class CameraVerdict : std::uint8_t {
  unknown, // the calibration names no camera, or the open one does not identify itself
  same,
  another,
};

// "unknown", "same", "another".
std::string_view to_string(CameraVerdict verdict);

// Compares them by name. Pure.
CameraVerdict compare_cameras(std::string_view calibrated, std::string_view open);

// For the log and the doctor, when a calibration names no camera: that it cannot be compared, and
// what to do. Pure.
std::string words_on_unnamed_camera(const std::filesystem::path& calibration);

// Bound to the render thread.
class CalibratedCamera {
public:
  // `calibrated`: Calibration::camera. `faults` outlives this.
  CalibratedCamera(std::string calibrated, pipeline::FaultLog& faults);

  // Call at every turn of the loop. Another camera is a fault, counted once when it appears. While
  // none is open, the verdict on the last one stays, as its picture does.
  void look(const hal::LineCamera& camera, hal::TimePoint now);

  CameraVerdict verdict() const { return verdict_; }
  const std::string& calibrated() const { return calibrated_; }
  const std::string& open() const { return open_; } // identity of the last one

private:
  std::string calibrated_;
  std::string open_;
  CameraVerdict verdict_ = CameraVerdict::unknown;
  pipeline::FaultLog& faults_;
};

} // namespace octascope::firmware_host
