// What differs between libcamera's versions (0.0.3 of Debian 12 to 0.5), and nothing else.
//
// transform became orientation in 0.2: both begin upright, and we ask for nothing else.
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

// Null where the camera has no stream for a display.
std::unique_ptr<libcamera::CameraConfiguration> display_configuration(libcamera::Camera& camera);

std::vector<BufferPlane> planes_of(const libcamera::FrameBuffer& buffer);

// Of the first plane: how long a JPEG is.
std::size_t bytes_used(const libcamera::FrameBuffer& buffer);

// In ns since the machine's start.
std::optional<std::int64_t> exposure_time(libcamera::Request& request);

// "imx477", "Integrated Camera"; the id where the camera has no model.
std::string model_of(const libcamera::Camera& camera);

// The video nodes that the camera is made of, as device numbers.
std::vector<dev_t> nodes_of(libcamera::CameraManager& manager,
                            const std::shared_ptr<libcamera::Camera>& camera);

// Asks for frames so far apart, as near as the camera can. Nothing where it cannot be asked.
void ask_for_period(const libcamera::Camera& camera, Duration period,
                    libcamera::ControlList& controls);

} // namespace octascope::hal::linux_backend
