// The spectrometer's line-scan camera: delivers B-scans of raw spectra.
//
// One frame is one B-scan: all lines of one fast-axis sweep, the kept A-scans first and then the
// fly-back lines, each line `samples_per_line` counts. The camera clocks its lines itself; the
// galvo trigger tells it when a sweep begins, so no frames come while nothing is triggered.
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
  int buffers = 96; // frames that may be on loan or waiting at once
};

// What the driver knows about a frame. A frame that is not `good` is handed out all the same, so
// that one place, the acquisition, decides and counts.
enum class FrameIntegrity : std::uint8_t {
  good,
  corrupted,  // the driver flagged an error
  wrong_size, // `bytes` is shorter or longer than the format says
};

// Borrowed from the camera until release(buffer) is called. Copying it copies the loan's address,
// not the loan: it is released once.
struct LineFrame {
  int buffer = -1; // 0 ≤ buffer < LineCameraConfig::buffers
  std::span<const std::byte> bytes;
  std::uint64_t sequence = 0; // counts every frame the hardware made, delivered or not
  TimePoint first_line;       // exposure of the first and of the last line
  TimePoint last_line;
  FrameIntegrity integrity = FrameIntegrity::good;
};

// Threads: open, start, wait_frame, stop and close belong to one thread at a time (the camera
// thread). release() may come from any thread while the camera is open. state() and identity() are
// free.
class LineCamera : public Device {
public:
  // absent → ready, or an Error and still absent. ErrorCode::absent means: try again later.
  // ErrorCode::invalid_argument: the configuration is impossible, the message has found and
  // expected.
  Result<> open(const LineCameraConfig& config) { return do_open(config); }

  // ready → streaming. Sequence numbers begin anew at each start.
  Result<> start() { return do_start(); }

  // Waits for the next frame, at most `timeout`. Nothing in time (no trigger, no light, no cable):
  // an empty optional, the stream goes on. ErrorCode::disconnected: the device is gone, the state
  // is `failed`; loans stay readable until close(); then open() again.
  Result<std::optional<LineFrame>> wait_frame(Duration timeout) { return do_wait_frame(timeout); }

  // Gives a loan back; its bytes must not be read afterwards. Numbers that are not on loan are
  // ignored. Neither allocates nor blocks.
  void release(int buffer) { do_release(buffer); }

  // streaming → ready; frames not yet fetched are discarded. Loans stay readable until release().
  void stop() { do_stop(); }

  // Any state → absent. All loans must have been released, or never be read again.
  void close() { do_close(); }

  // Which camera the last open() found, so that it can be told from another of its kind: the same
  // after a replug, in another socket and in another machine. One line, for people to copy. Empty
  // before the first open(), and where nothing can be known of it. Allocates.
  std::string identity() const { return do_identity(); }

private:
  virtual Result<> do_open(const LineCameraConfig& config) = 0;
  virtual Result<> do_start() = 0;
  virtual Result<std::optional<LineFrame>> do_wait_frame(Duration timeout) = 0;
  virtual void do_release(int buffer) = 0;
  virtual void do_stop() = 0;
  virtual void do_close() = 0;
  virtual std::string do_identity() const = 0;
};

} // namespace octascope::hal
