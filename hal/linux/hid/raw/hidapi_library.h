// hidapi as a whole: begun by its first user, ended by its last.
#pragma once

#include <mutex>

namespace octascope::hal::linux_backend {

// A user of hidapi. hidapi guards nothing itself: what it keeps for the process, its last error
// above all, is written by whoever begins it, ends it, lists devices or opens one. A device's own
// calls need no lock.
class HidapiLibrary {
public:
  HidapiLibrary();
  ~HidapiLibrary();
  HidapiLibrary(const HidapiLibrary&) = delete;
  HidapiLibrary& operator=(const HidapiLibrary&) = delete;

  // Held around hid_enumerate(), hid_open_path() and hid_error() without a device.
  [[nodiscard]] std::unique_lock<std::mutex> lock() const;
};

} // namespace octascope::hal::linux_backend
