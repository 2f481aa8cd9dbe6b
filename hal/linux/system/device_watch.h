// Tells when devices of one kind come and go, without asking again and again: the kernel's events
// by libudev.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct DeviceChange {
  enum class Kind { added, removed, changed } kind = Kind::changed;
  std::string node; // "/dev/video0"; empty for what has none
  std::string path; // in /sys
};

// Threads: one thread at a time.
class DeviceWatch {
public:
  // `subsystem` as in /sys/class: "video4linux", "hidraw", "gpio", "drm", "input". The events come
  // from udevd, when the node's permissions are set; where no udevd runs, from the kernel.
  static Result<DeviceWatch> on(const char* subsystem);
  DeviceWatch(DeviceWatch&&) noexcept;
  DeviceWatch& operator=(DeviceWatch&&) noexcept;
  ~DeviceWatch();

  // The next change, waiting at most `timeout`; 0 never waits.
  std::optional<DeviceChange> next(Duration timeout);

  // Readable when next(0) has something to tell: for a poll together with other files.
  int descriptor() const;

private:
  struct Monitor;
  explicit DeviceWatch(std::unique_ptr<Monitor> monitor);
  std::unique_ptr<Monitor> monitor_;
};

} // namespace octascope::hal::linux_backend
