#include "tests/ui/support/scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octascope::tests {

ui::Status live_status() {
  ui::Status status;
  status.now = hal::TimePoint{std::chrono::seconds{100}};
  status.volumes_per_s = 7.09;
  status.shown_volumes_per_s = 6.62;
  status.lines_per_s = 214'900;
  status.frames_per_s = 59.8;
  status.latency_p50_ms = 31.6;
  status.latency_p95_ms = 44.2;
  using pipeline::Device;
  status.devices = {{{Device::line_camera, "sim", hal::DeviceState::streaming},
                     {Device::galvo_trigger, "sim", hal::DeviceState::ready},
                     {Device::control_input, "sim", hal::DeviceState::ready},
                     {Device::scope_camera, "sim", hal::DeviceState::streaming},
                     {Device::display, "offscreen", hal::DeviceState::ready}}};
  status.device_count = 5;
  status.simulated = true;
  status.time_of_day = "14:05";
  status.source_description = "Phantom tissue, loop of 2.3 s";
  status.freshness = {ui::Liveness::live, std::chrono::milliseconds{60}, {}};
  return status;
}

ui::Status worst_status() {
  ui::Status status = live_status();
  status.freshness = {ui::Liveness::veiled, std::chrono::seconds{3599}, {}};
  status.missing_b_scans = 80;
  status.saturated_lines = 23'456;
  status.losses = {12'345, 67, 8};
  status.reduced_quality = 0.67F;
  status.notice = "Camera lost: looking for it again";
  status.vessels.state = ui::VesselStatus::State::shown; // and not registered
  status.recording = {.on = true,
                      .lasted = std::chrono::seconds{5999},
                      .not_kept = 12,
                      .room = std::chrono::hours{5}};
  return status;
}

void mark_incomplete(pipeline::Volume& volume) {
  for (const int b : {11, 12, 13}) {
    volume.b_scan_states[static_cast<std::size_t>(b)] = pipeline::BScanState::missing;
    std::ranges::fill(volume.b_scan(b), std::uint8_t{0});
  }
  for (const int b : {20, 21})
    volume.b_scan_states[static_cast<std::size_t>(b)] = pipeline::BScanState::saturated;
}

ScopePicture::ScopePicture(int width, int height)
    : width_{width}, height_{height},
      rgb_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  auto pixel = rgb_.begin();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double dx = (x + 0.5 - 0.5 * width) / height;
      const double dy = (y + 0.5 - 0.5 * height) / height;
      const double r = std::hypot(dx, dy);
      const double ray = 0.5 + 0.5 * std::sin(40 * std::atan2(dy, dx) + 9 * r);
      std::array<double, 3> colour{214 - 60 * r, 190 - 80 * r, 180 - 80 * r};
      if (r < 0.36)
        colour = {70 + 40 * ray, 88 + 40 * ray, 92 + 42 * ray};
      if (r < 0.14)
        colour = {14, 12, 14};
      for (const double value : colour)
        *pixel++ = static_cast<std::byte>(std::clamp(value, 0.0, 255.0));
    }
}

hal::ScopeFrame ScopePicture::frame(hal::TimePoint time) const {
  return {0, width_, height_, 3 * width_, hal::PixelFormat::rgb8, rgb_, 1, time};
}

ui::ScanField ScopePicture::field() const {
  return {{{{0.42F, 0.22F}, {0.68F, 0.28F}, {0.62F, 0.60F}, {0.36F, 0.54F}}}};
}

} // namespace octascope::tests
