// The microscope camera, which images the field in ambient light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "hal/device.h"
#include "hal/result.h"

namespace octascope::hal {

struct ScopeCameraConfig {
  int width = 640; // preferences: the frames tell what the camera delivers
  int height = 480;
  double frames_per_s = 30;
};

enum class PixelFormat : std::uint8_t { rgb8, rgba8, yuyv, nv12 };

// Borrowed from the camera until release(buffer). Row 0 is the top of the image.
struct ScopeFrame {
  int buffer = -1;
  int width = 0;
  int height = 0;
  int stride_bytes = 0;
  PixelFormat format = PixelFormat::rgb8;
  std::span<const std::byte> pixels;
  std::uint64_t sequence = 0;
  TimePoint time;
};

// Threads: open, start, wait_frame, stop and close from one thread at a time; release() and state()
// from any thread.
class ScopeCamera : public Device {
public:
  // absent → ready.
  Result<> open(const ScopeCameraConfig& config) {
    HAL_CHECK(in_order(kind, "open", DeviceState::absent));
    return do_open(config);
  }
  // ready → streaming.
  Result<> start() {
    HAL_CHECK(in_order(kind, "start", DeviceState::ready));
    return do_start();
  }
  // Like LineCamera::wait_frame.
  Result<std::optional<ScopeFrame>> wait_frame(Duration timeout) {
    HAL_CHECK(in_order(kind, "wait_frame", DeviceState::streaming));
    return do_wait_frame(timeout);
  }
  void release(int buffer) { do_release(buffer); }
  // streaming → ready.
  void stop() { do_stop(); }
  // Any state → absent.
  void close() { do_close(); }

private:
  static constexpr std::string_view kind = "scope camera";

  virtual Result<> do_open(const ScopeCameraConfig& config) = 0;
  virtual Result<> do_start() = 0;
  virtual Result<std::optional<ScopeFrame>> do_wait_frame(Duration timeout) = 0;
  virtual void do_release(int buffer) = 0;
  virtual void do_stop() = 0;
  virtual void do_close() = 0;
};

} // namespace octascope::hal
