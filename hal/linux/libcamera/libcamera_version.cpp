#include "hal/linux/libcamera/libcamera_version.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include <libcamera/camera.h>
#include <libcamera/camera_manager.h>
#include <libcamera/control_ids.h>
#include <libcamera/framebuffer.h>
#include <libcamera/property_ids.h>
#include <libcamera/request.h>
#include <libcamera/version.h>
#include <sys/sysmacros.h>

#define OCTASCOPE_LIBCAMERA_AT_LEAST(major, minor)                                                 \
  (LIBCAMERA_VERSION_MAJOR > (major) ||                                                            \
   (LIBCAMERA_VERSION_MAJOR == (major) && LIBCAMERA_VERSION_MINOR >= (minor)))

namespace octascope::hal::linux_backend {

std::unique_ptr<libcamera::CameraConfiguration> display_configuration(libcamera::Camera& camera) {
#if OCTASCOPE_LIBCAMERA_AT_LEAST(0, 1) // takes a span
  constexpr std::array roles{libcamera::StreamRole::Viewfinder};
  return camera.generateConfiguration(roles);
#else
  return camera.generateConfiguration({libcamera::StreamRole::Viewfinder});
#endif
}

std::vector<BufferPlane> planes_of(const libcamera::FrameBuffer& buffer) {
  std::vector<BufferPlane> planes;
  for (const libcamera::FrameBuffer::Plane& plane : buffer.planes()) // a vector, later a span
    planes.push_back(
        {plane.fd.get(),
         plane.offset == libcamera::FrameBuffer::Plane::kInvalidOffset ? 0 : plane.offset,
         plane.length});
  return planes;
}

std::size_t bytes_used(const libcamera::FrameBuffer& buffer) {
  const auto planes = buffer.metadata().planes(); // a span
  return planes.empty() ? 0 : planes[0].bytesused;
}

std::optional<std::int64_t> exposure_time(libcamera::Request& request) {
  return request.metadata().get(libcamera::controls::SensorTimestamp);
}

std::string model_of(const libcamera::Camera& camera) {
  // A string, later a view of one.
  if (const auto model = camera.properties().get(libcamera::properties::Model))
    return std::string{*model};
  return camera.id();
}

#if OCTASCOPE_LIBCAMERA_AT_LEAST(0, 1)
std::vector<dev_t> nodes_of(libcamera::CameraManager&,
                            const std::shared_ptr<libcamera::Camera>& camera) {
  std::vector<dev_t> nodes;
  if (const auto numbers = camera->properties().get(libcamera::properties::SystemDevices))
    for (const std::int64_t number : *numbers)
      nodes.push_back(static_cast<dev_t>(number));
  return nodes;
}
#else
std::vector<dev_t> nodes_of(libcamera::CameraManager& manager,
                            const std::shared_ptr<libcamera::Camera>& camera) {
  std::vector<dev_t> nodes;
  std::error_code error;
  for (std::filesystem::directory_iterator it{"/sys/class/video4linux", error}, end;
       !error && it != end; it.increment(error)) {
    unsigned major_number = 0;
    unsigned minor_number = 0;
    char colon = 0;
    std::ifstream in{it->path() / "dev"};
    if (!(in >> major_number >> colon >> minor_number))
      continue;
    const dev_t node = makedev(major_number, minor_number);
    if (manager.get(node) == camera)
      nodes.push_back(node);
  }
  return nodes;
}
#endif

void ask_for_period(const libcamera::Camera& camera, Duration period,
                    libcamera::ControlList& controls) {
  const libcamera::ControlId& limits = libcamera::controls::FrameDurationLimits;
  const auto known = camera.controls().find(&limits);
  if (known == camera.controls().end())
    return;
  const auto least = known->second.min().get<std::int64_t>();
  const auto most = std::max(least, known->second.max().get<std::int64_t>());
  const std::int64_t us = std::clamp<std::int64_t>(
      std::chrono::round<std::chrono::microseconds>(period).count(), least, most);
  const std::array<std::int64_t, 2> both{us, us};
  controls.set(libcamera::controls::FrameDurationLimits,
               libcamera::Span<const std::int64_t, 2>{both});
}

} // namespace octascope::hal::linux_backend
