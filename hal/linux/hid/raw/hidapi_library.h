// Initialises hidapi for its first user and ends it after its last.
#pragma once

#include <mutex>

namespace octascope::hal::linux_backend {

// A user of hidapi. hidapi's global state, in particular its last error, is not thread-safe: it is
// written when hidapi is initialised or ended and when devices are listed or opened. The calls on
// an open device need no lock.
class HidapiLibrary {
public:
  HidapiLibrary();
  ~HidapiLibrary();
  HidapiLibrary(const HidapiLibrary&) = delete;
  HidapiLibrary& operator=(const HidapiLibrary&) = delete;

  // To be held during hid_enumerate(), hid_open_path() and hid_error() without a device.
  [[nodiscard]] std::unique_lock<std::mutex> lock() const;
};

} // namespace octascope::hal::linux_backend
