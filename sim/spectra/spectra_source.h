// The source of the simulated line camera's frames: a phantom's precomputed loop, or a recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "hal/line_camera.h"

namespace octascope::sim {

// Thread-safe once constructed. frame() neither waits nor allocates, so that streaming costs next
// to nothing.
class SpectraSource {
public:
  virtual ~SpectraSource() = default;

  virtual const hal::LineFormat& format() const = 0;
  virtual int sweeps() const = 0; // per volume, including repeats
  // The distance between sweeps of the same direction and the same repeat of a B-scan.
  virtual int alike_every() const { return 1; }
  virtual int sweeps_per_b_scan() const { return 1; }

  // All lines of one sweep, including fly-back or turn-around, format().frame_bytes() long; valid
  // for the source's lifetime. Volume numbers start at 0 and grow without limit; the source loops.
  virtual std::span<const std::byte> frame(std::uint64_t volume, int sweep) const = 0;

  // For display: the kind of source and the duration of its loop.
  virtual std::string description() const = 0;
};

} // namespace octascope::sim
