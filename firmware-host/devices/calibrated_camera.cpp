#include "firmware-host/devices/calibrated_camera.h"

#include <utility>

#include <fmt/format.h>

namespace octascope::firmware_host {

std::string_view to_string(CameraVerdict verdict) {
  switch (verdict) {
  case CameraVerdict::unknown: break;
  case CameraVerdict::same: return "same";
  case CameraVerdict::another: return "another";
  }
  return "unknown";
}

CameraVerdict compare_cameras(std::string_view calibrated, std::string_view open) {
  if (calibrated.empty() || open.empty())
    return CameraVerdict::unknown;
  return calibrated == open ? CameraVerdict::same : CameraVerdict::another;
}

std::string words_on_unnamed_camera(const std::filesystem::path& calibration) {
  return fmt::format(
      "{} names no camera, so nobody notices when it is another machine's; `octascope "
      "devices` tells the camera, and [spectrometer] camera = \"…\" names it",
      calibration.string());
}

CalibratedCamera::CalibratedCamera(std::string calibrated, pipeline::FaultLog& faults)
    : calibrated_{std::move(calibrated)}, faults_{faults} {}

void CalibratedCamera::look(const hal::LineCamera& camera, hal::TimePoint now) {
  std::string found = camera.identity();
  if (found == open_)
    return;
  open_ = std::move(found);
  verdict_ = compare_cameras(calibrated_, open_);
  if (verdict_ == CameraVerdict::another)
    faults_.add(
        pipeline::Fault::another_camera,
        fmt::format("the calibration is of the camera \"{}\", and \"{}\" is open: depths may "
                    "be wrong. Plug in the former, or name the calibration of the latter "
                    "in the configuration",
                    calibrated_, open_),
        now);
}

} // namespace octascope::firmware_host
