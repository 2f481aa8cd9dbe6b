// A V4L2 driver modelled in this process: the line camera's system calls come here instead of to
// the kernel, so that its whole contract is tried, loans and unplugging included, on any machine,
// in virtual time, under the sanitizers. What it models are the rules of the kernel's videobuf2
// (linux/videodev2.h and drivers/media/common/videobuf2): buffers on loan are not written to, a
// stream that is stopped gives its buffers back, poll() with no buffer queued since the start ends
// at once with POLLERR, a device that has gone says ENODEV for as long as it is held open.
//
// modelled_driver.cpp stands before the C library's open, close, ioctl, ppoll and mmap; they reach
// the one driver that is alive, for its node alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

#include <linux/videodev2.h>

#include "hal/clock.h"
#include "hal/line_camera.h"

namespace octascope::tests {

// One in a process, one opener at a time. Thread-safe.
class ModelledDriver {
public:
  static constexpr const char* node = "/dev/octascope-modelled-camera";
  static constexpr std::uint32_t most_buffers = 32;
  static constexpr std::uint32_t first_raw_sequence = 0xFFFF'FFF8; // it wraps soon

  ModelledDriver(const hal::LineCameraConfig& makes, int frames_per_sweep, hal::Clock& clock);
  ~ModelledDriver();
  ModelledDriver(const ModelledDriver&) = delete;
  ModelledDriver& operator=(const ModelledDriver&) = delete;

  // A sweep begins, now or at the end of the one that runs.
  void trigger();
  void unplug();
  void replug();

  // What the C library's functions are asked for this node and its descriptor. −1 with errno set.
  int open_node();
  bool owns(int descriptor) const;
  void closed(int descriptor);
  int control(unsigned long request, void* argument);
  int wait(short& revents, hal::Duration timeout);

private:
  enum class Place : std::uint8_t { outside, queued, done };
  struct Buffer {
    Place place = Place::outside;
    v4l2_buffer filled{};
  };

  int answer(unsigned long request, void* argument);
  int set_format(v4l2_format& format) const;
  int request_buffers(v4l2_requestbuffers& request);
  int queue(v4l2_buffer& buffer);
  int fetch(v4l2_buffer& buffer);
  int stream(bool on);
  void expose_until(hal::TimePoint now);
  void fill(std::uint32_t index, hal::TimePoint end);
  hal::TimePoint next_look(hal::TimePoint now, hal::TimePoint deadline) const;

  const hal::LineCameraConfig makes_;
  const int frames_per_sweep_;
  const hal::Duration frame_period_;
  hal::Clock& clock_;

  mutable std::mutex mutex_;
  int descriptor_ = -1; // memory of a file: what is mapped is real
  bool plugged_ = true;
  bool gone_ = false; // unplugged since it was opened
  bool streaming_ = false;
  bool queued_since_start_ = false;
  hal::TimePoint started_;
  std::uint32_t raw_sequence_ = first_raw_sequence; // goes on over a stop, as some drivers do
  hal::TimePoint next_end_;                         // of the frame that is exposed next
  int frames_to_come_ = 0;

  std::size_t buffer_bytes_ = 0;
  std::uint32_t count_ = 0;
  std::array<Buffer, most_buffers> buffers_;
  // Rings of buffer numbers: nothing here allocates while it streams.
  std::array<std::uint32_t, most_buffers> queued_{}, done_{};
  std::uint32_t queued_begin_ = 0, queued_end_ = 0, done_begin_ = 0, done_end_ = 0;
};

} // namespace octascope::tests
