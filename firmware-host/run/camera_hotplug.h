// A line camera that serves after all, once its twin does: plugged in late, or given to its group
// by udev when the program had looked already.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "hal/linux/system/device_watch.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// Looks in a thread of its own: at once, since the camera may have come meanwhile, then whenever a
// video device comes or changes. Ends looking when there is one.
class CameraHotplug {
public:
  // `serves` opens the video devices and asks, in that thread alone. Without the kernel's events it
  // looks once.
  explicit CameraHotplug(std::function<bool()> serves);

  // Never waits; any thread.
  bool came() const { return came_.load(std::memory_order_relaxed); }

private:
  void look(const std::stop_token& stop);

  const std::function<bool()> serves_;
  hal::Result<hal::linux_backend::DeviceWatch> events_; // from before the first look
  std::atomic<bool> came_{false};
  std::jthread thread_; // last: it uses all of the above
};

} // namespace octascope::firmware_host
