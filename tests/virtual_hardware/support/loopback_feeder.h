// Writes B-scans into a v4l2loopback node, from whose other side a program reads them through the
// kernel as from a camera.
//
// What the driver does (v4l2loopback 0.12.7, read and tried): the reader finds no format until the
// writer's stream is on; a reader more than two frames behind is set to the newest frame; a frame
// is written into the next buffer in turn, whether or not a reader still has it; frames are
// numbered through, and stamped with the monotonic clock without saying so.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::tests {

// Threads: one thread at a time.
class LoopbackFeeder {
public:
  // The first node of such a driver; nothing where there is none.
  static std::optional<std::string> find();

  // From then on the node is a camera of 16-bit samples of that size. ErrorCode::busy while the
  // node keeps another size for somebody who has it open.
  static hal::Result<LoopbackFeeder> open(const std::string& node, int samples_per_line,
                                          int lines_per_frame);

  // One B-scan, little-endian, C order [lines][samples]; exactly of the frame's size, but shorter
  // ones are written too, as a broken camera would.
  hal::Result<> write(std::span<const std::byte> frame);

  const std::string& node() const { return node_; }
  std::size_t frame_bytes() const { return frame_bytes_; }

private:
  LoopbackFeeder(hal::linux_backend::FileDescriptor file, std::string node, std::size_t bytes)
      : file_{std::move(file)}, node_{std::move(node)}, frame_bytes_{bytes} {}

  hal::linux_backend::FileDescriptor file_;
  std::string node_;
  std::size_t frame_bytes_;
};

} // namespace octascope::tests
