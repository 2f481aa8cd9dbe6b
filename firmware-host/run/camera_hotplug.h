// Notices a line camera that becomes available while its twin serves: plugged in late, or given its
// permissions by udev only after the program had looked.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "hal/linux/system/device_watch.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// Looks on its own thread: at once, since a camera may have appeared meanwhile, then whenever a
// video device appears or changes. Stops once one is found.
class CameraHotplug {
public:
  // `serves` opens the video devices and asks, on that thread only. Without kernel events it looks
  // once.
  explicit CameraHotplug(std::function<bool()> serves);

  // Never blocks; any thread.
  bool came() const { return came_.load(std::memory_order_relaxed); }

private:
  void look(const std::stop_token& stop);

  const std::function<bool()> serves_;
  hal::Result<hal::linux_backend::DeviceWatch> events_; // from before the first look
  std::atomic<bool> came_{false};
  std::jthread thread_; // last: it uses all of the above
};

} // namespace octascope::firmware_host
