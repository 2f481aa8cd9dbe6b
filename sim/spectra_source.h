// Where the twin of the line camera takes its frames from: a phantom's precomputed loop or a
// recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "hal/line_camera.h"

namespace octascope::sim {

// Thread-safe once made; frame() neither waits nor allocates, so that the twin costs next to
// nothing while it streams.
class SpectraSource {
public:
  virtual ~SpectraSource() = default;

  virtual const hal::LineFormat& format() const = 0;
  virtual int b_scans() const = 0; // per volume

  // All lines of one B-scan, fly-back included, format().frame_bytes() long, valid as long as the
  // source lives. Volumes count from 0 for ever; the source loops.
  virtual std::span<const std::byte> frame(std::uint64_t volume, int b_scan) const = 0;

  // For people: what this is and how long its loop lasts.
  virtual std::string description() const = 0;
};

} // namespace octascope::sim
