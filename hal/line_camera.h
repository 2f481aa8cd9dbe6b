// The spectrometer's line-scan camera: delivers B-scans of raw spectra.
//
// One frame is one B-scan: all lines of one fast-axis sweep, first the A-scans that are kept, then
// the fly-back lines, each of `samples_per_line` counts. The camera clocks its own lines; the galvo
// trigger starts each sweep, so no frames arrive without a trigger.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/clock.h"
#include "hal/device.h"
#include "hal/result.h"
#include "hal/sample_type.h"

namespace octascope::hal {

struct LineFormat {
  int samples_per_line = 1024;
  int lines_per_frame = 379;                // kept A-scans and fly-back lines together
  SampleType sample_type = SampleType::u16; // u8 or u16
  int significant_bits = 12; // full scale is 2^significant_bits − 1 after the shift
  int right_shift = 0;       // for left-justified grabbers

  std::size_t line_bytes() const {
    return static_cast<std::size_t>(samples_per_line) * bytes_per_sample(sample_type);
  }
  std::size_t frame_bytes() const {
    return static_cast<std::size_t>(lines_per_frame) * line_bytes();
  }
  bool operator==(const LineFormat&) const = default;
};

struct LineCameraConfig {
  LineFormat format;
  double line_rate_hz = 215e3;
  int buffers = 96; // frames that may be borrowed or waiting at once
};

// What the driver reports about a frame. Frames that are not `good` are delivered too: the
// acquisition alone counts them and decides what to do.
enum class FrameIntegrity : std::uint8_t {
  good,
  corrupted,  // the driver flagged an error
  wrong_size, // `bytes` is shorter or longer than the format's frame_bytes()
};

// Borrowed from the camera until release(buffer). Copies refer to the same buffer, which is
// released once.
struct LineFrame {
  int buffer = -1; // 0 ≤ buffer < LineCameraConfig::buffers
  std::span<const std::byte> bytes;
  std::uint64_t sequence = 0; // counts every frame the hardware produced, delivered or not
  TimePoint first_line;       // exposure times of the first and the last line
  TimePoint last_line;
  FrameIntegrity integrity = FrameIntegrity::good;
  // The camera's own time stamps do not fit the host's clock: the exposure times are told from when the
  // frame came, later by what its transport took.
  bool timed_by_host = false;
  TimePoint fetched{}; // when the host had it; whoever takes it from the camera notes it
};

// A number that a camera lets one set.
struct CameraControl {
  double value = 0; // at present
  double least = 0;
  double most = 0;
};

struct CameraControls { // empty: it has no such control
  std::optional<CameraControl> exposure_us;
  std::optional<CameraControl> gain; // in the camera's own steps
};

// Threads: open, controls, start, wait_frame, stop and close from one thread at a time (the camera thread);
// release() from any thread while the camera is open; state() and identity() from any thread.
class LineCamera : public Device {
public:
  // absent → ready; stays absent on an error. ErrorCode::absent: try again later.
  // ErrorCode::invalid_argument: the configuration is impossible; the message says what was found
  // and expected.
  Result<> open(const LineCameraConfig& config) {
    HAL_CHECK(in_order(kind, "open", DeviceState::absent));
    return do_open(config);
  }

  // As open() left them; nothing while absent. May take as long as the camera takes to answer.
  CameraControls controls() const { return do_controls(); }

  // How many buffers the last open() got, if fewer than the configuration asked for. Camera thread.
  std::optional<int> fewer_buffers() const { return do_fewer_buffers(); }

  // ready → streaming. Sequence numbers restart at each start. ErrorCode::absent: the camera has not
  // answered yet and stays `ready`; the next start() goes on with it, stop() and close() end it.
  Result<> start() {
    HAL_CHECK(in_order(kind, "start", DeviceState::ready));
    return do_start();
  }

  // Waits at most `timeout` for the next frame. Returns an empty optional on a timeout (no trigger,
  // no light, no cable); the stream continues. ErrorCode::disconnected: the device is gone and the
  // state is `failed`; borrowed frames stay readable until close(), then open() again.
  Result<std::optional<LineFrame>> wait_frame(Duration timeout) {
    HAL_CHECK(in_order(kind, "wait_frame", DeviceState::streaming));
    return do_wait_frame(timeout);
  }

  // Returns a borrowed buffer; its bytes must not be read afterwards. Buffers that are not borrowed
  // are ignored. Neither allocates nor blocks.
  void release(int buffer) { do_release(buffer); }

  // streaming → ready; discards frames not yet fetched. Borrowed frames stay readable until
  // release().
  void stop() { do_stop(); }

  // Any state → absent. Frames that are still borrowed must not be read afterwards.
  void close() { do_close(); }

  // Identifies the camera that the last open() found, among others of the same model: unchanged
  // after a replug, in another socket or on another machine. One line, for people to copy. Empty
  // before the first open() and if the camera cannot be identified. Allocates.
  std::string identity() const { return do_identity(); }

private:
  static constexpr std::string_view kind = "line camera";

  virtual Result<> do_open(const LineCameraConfig& config) = 0;
  virtual std::optional<int> do_fewer_buffers() const { return std::nullopt; }
  virtual Result<> do_start() = 0;
  virtual Result<std::optional<LineFrame>> do_wait_frame(Duration timeout) = 0;
  virtual void do_release(int buffer) = 0;
  virtual void do_stop() = 0;
  virtual void do_close() = 0;
  virtual std::string do_identity() const = 0;
  virtual CameraControls do_controls() const { return {}; }
};

} // namespace octascope::hal
