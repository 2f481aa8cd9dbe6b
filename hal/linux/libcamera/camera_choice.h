// Which of libcamera's cameras looks through the microscope, and what to say where there is none.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct LibcameraFound {
  std::string id;     // libcamera's name of it: the same after each start, on the same socket
  std::string model;  // for people
  bool taken = false; // it is the line camera
};

// The first whose id or model is `wish`, else the first whose id or model contains it; without a
// wish the first that is not taken. Pure. ErrorCode::absent: none; the message lists those that
// are.
Result<std::size_t> choose_camera(const std::vector<LibcameraFound>& found,
                                  const std::string& wish);

// Why libcamera lists no camera at all, with what fixes it: no udev daemon (it finds cameras in
// udevd's database alone), media nodes that this user may not open (it skips them silently:
// ErrorCode::denied), the package libcamera-ipa missing, or nothing plugged in. Looks at
// `root`/run, /dev and /usr/lib, opens nothing.
Error explain_absence(const std::filesystem::path& root = "/");

} // namespace octascope::hal::linux_backend
