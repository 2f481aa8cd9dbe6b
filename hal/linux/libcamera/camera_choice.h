// Chooses the microscope camera among libcamera's cameras, and explains why there is none.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct LibcameraFound {
  std::string id;     // libcamera's: stable across restarts on the same socket
  std::string model;  // for people
  bool taken = false; // it is the line camera
};

// The first camera whose id or model is `wanted`, else the first whose id or model contains it; if
// `wanted` is empty, the first that is not taken. ErrorCode::absent: none; the message lists the
// cameras found. Pure.
Result<std::size_t> choose_camera(const std::vector<LibcameraFound>& found,
                                  const std::string& wanted);

// Why libcamera lists no camera at all, with the remedy: no udev daemon (libcamera finds cameras
// only in udevd's database), media nodes that this user may not open (libcamera skips them
// silently: ErrorCode::denied), the package libcamera-ipa is missing, or nothing is plugged in.
// Looks in `root`/run, /dev and /usr/lib; opens nothing.
Error explain_absence(const std::filesystem::path& root = "/");

} // namespace octascope::hal::linux_backend
