// Reports when devices of one subsystem are added, removed or changed, without polling: uses the
// kernel's events through libudev.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct DeviceChange {
  enum class Kind { added, removed, changed } kind = Kind::changed;
  std::string node; // "/dev/video0"; empty if the device has none
  std::string path; // in /sys
};

// Threads: one thread at a time.
class DeviceWatch {
public:
  // `subsystem` as in /sys/class: "video4linux", "hidraw", "gpio", "drm", "input". Events come from
  // udevd, after it has set the node's permissions, or from the kernel if udevd does not run.
  static Result<DeviceWatch> on(const char* subsystem);
  DeviceWatch(DeviceWatch&&) noexcept;
  DeviceWatch& operator=(DeviceWatch&&) noexcept;
  ~DeviceWatch();

  // Waits at most `timeout` for the next change; with 0 it does not wait.
  std::optional<DeviceChange> next(Duration timeout);

  // Becomes readable when next(0) has a change; to be polled together with other files.
  int descriptor() const;

private:
  struct Monitor;
  explicit DeviceWatch(std::unique_ptr<Monitor> monitor);
  std::unique_ptr<Monitor> monitor_;
};

} // namespace octascope::hal::linux_backend
