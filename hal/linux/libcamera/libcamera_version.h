// Only what differs between libcamera's versions, from 0.0.3 (Debian 12) to 0.5.
//
// `transform` became `orientation` in 0.2; both default to upright, and we never change it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "hal/clock.h"
#include "hal/linux/libcamera/plane_plan.h"

namespace libcamera {
class Camera;
class CameraConfiguration;
class CameraManager;
class ControlList;
class FrameBuffer;
class Request;
} // namespace libcamera

namespace octascope::hal::linux_backend {

// Null if the camera has no stream for a display.
std::unique_ptr<libcamera::CameraConfiguration> display_configuration(libcamera::Camera& camera);

std::vector<BufferPlane> planes_of(const libcamera::FrameBuffer& buffer);

// Of the first plane: the length of a JPEG.
std::size_t bytes_used(const libcamera::FrameBuffer& buffer);

// In ns since boot.
std::optional<std::int64_t> exposure_time(libcamera::Request& request);

// "imx477", "Integrated Camera"; the id if the camera has no model.
std::string model_of(const libcamera::Camera& camera);

// The device numbers of the camera's video nodes.
std::vector<dev_t> nodes_of(libcamera::CameraManager& manager,
                            const std::shared_ptr<libcamera::Camera>& camera);

// Requests the frame period nearest to `period` that the camera allows. Does nothing if the camera
// has no such control.
void ask_for_period(const libcamera::Camera& camera, Duration period,
                    libcamera::ControlList& controls);

} // namespace octascope::hal::linux_backend
