// The source of the line camera twin's frames: a phantom's precomputed loop or a recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "hal/line_camera.h"

namespace octascope::sim {

// Thread-safe once made; frame() neither waits nor allocates, so that streaming costs almost
// nothing.
class SpectraSource {
public:
  virtual ~SpectraSource() = default;

  virtual const hal::LineFormat& format() const = 0;
  virtual int sweeps() const = 0; // of a volume, repeats counted
  // The distance between sweeps of the same direction and the same repeat of a B-scan.
  virtual int alike_every() const { return 1; }
  virtual int sweeps_per_b_scan() const { return 1; }

  // All lines of one sweep, including fly-back or turn-around, format().frame_bytes() long, valid
  // as long as the source. Volumes count from 0 without end; the source loops.
  virtual std::span<const std::byte> frame(std::uint64_t volume, int sweep) const = 0;

  // For people: what this is and the length of its loop.
  virtual std::string description() const = 0;
};

} // namespace octascope::sim
