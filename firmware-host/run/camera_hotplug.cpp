#include "firmware-host/run/camera_hotplug.h"

#include <chrono>
#include <utility>

#include "hal/linux/realtime.h"

namespace octascope::firmware_host {

using namespace std::chrono_literals;

CameraHotplug::CameraHotplug(std::function<bool()> serves)
    : serves_{std::move(serves)}, events_{hal::linux_backend::DeviceWatch::on("video4linux")},
      thread_{[this](const std::stop_token& stop) { look(stop); }} {}

void CameraHotplug::look(const std::stop_token& stop) {
  hal::linux_backend::name_this_thread("late camera");
  while (!stop.stop_requested()) {
    if (serves_()) {
      came_.store(true, std::memory_order_relaxed);
      return;
    }
    if (!events_)
      return;
    // One camera has several nodes, and their events come together: they are looked at together.
    while (!stop.stop_requested() && !events_->next(200ms)) {
    }
    while (!stop.stop_requested() && events_->next(200ms)) {
    }
  }
}

} // namespace octascope::firmware_host
