// Opens a camera by its name, and sets what the spectra need. One thread at a time for one camera.
#pragma once

#include <string>
#include <vector>

#include "hal/line_camera.h"
#include "hal/linux/aravis/aravis_library.h"
#include "hal/linux/aravis/genicam_camera.h"
#include "hal/linux/aravis/packed_samples.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// What a camera delivers after it was set.
struct CameraStream {
  ArvPixelFormat pixel_format{};
  Packing packing{};
  int bits = 0;                  // of a sample as it is sent
  std::size_t payload_bytes = 0; // of a frame, with what the camera appends
};

// Of the buses only the address's is asked. ErrorCode::absent: it does not answer (yet).
Result<Reference<ArvCamera>> open_camera(const AravisLibrary& aravis,
                                         const GenicamAddress& address);

// Vendor, model and serial number, as far as it tells them.
std::string identity_of(const AravisLibrary& aravis, ArvCamera* camera);

Result<std::vector<std::string>> offered_formats(const AravisLibrary& aravis, ArvCamera* camera,
                                                 const std::string& name);

// Format, size, line rate, exposure, gain and trigger. What is explicitly asked for and cannot be had
// is an error with found and expected; a camera without a feature for its line rate keeps its own.
Result<CameraStream> set_features(const AravisLibrary& aravis, ArvCamera* camera,
                                  const GenicamCameraOptions& options,
                                  const LineCameraConfig& config);

// Exposure and gain as they are, where the camera has them.
CameraControls controls_of(const AravisLibrary& aravis, ArvCamera* camera);

} // namespace octascope::hal::linux_backend
