// The kernel's virtual media-controller camera, which libcamera drives.
#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "hal/linux/libcamera/libcamera_session.h"
#include "hal/linux/monotonic_clock.h"

namespace octascope::tests {

constexpr auto vimc_driver = "/sys/bus/platform/drivers/vimc";

inline bool has_vimc() {
  return std::filesystem::exists(std::string{vimc_driver} + "/bind");
}
constexpr auto no_vimc =
    "this kernel has no vimc driver: run it in the bench's kernel (tests/virtual_hardware)";

inline bool write_to_driver(const char* file) {
  std::ofstream out{std::string{vimc_driver} + "/" + file};
  out << "vimc.0" << std::flush;
  return out.good();
}
inline bool vimc_is_bound() {
  return std::filesystem::exists(std::string{vimc_driver} + "/vimc.0");
}
inline void unplug_vimc() {
  if (vimc_is_bound())
    write_to_driver("unbind");
}

// Until libcamera lists it (or no longer); udevd has to set up its nodes first.
inline bool wait_for_cameras(hal::linux_backend::LibcameraSession& session, bool there) {
  for (int i = 0; i < 1000; ++i) {
    if (session.cameras().empty() != there)
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return false;
}
inline bool replug_vimc(hal::linux_backend::LibcameraSession& session) {
  if (!vimc_is_bound())
    write_to_driver("bind");
  return wait_for_cameras(session, true);
}

} // namespace octascope::tests
