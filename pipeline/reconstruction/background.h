// The background of a B-scan: what the spectrum is without interference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/line_camera.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/reconstruction/spectrum_format.h"

namespace octascope::pipeline {

// How many B-scans the running mean looks back: the first ones are averaged evenly, after that
// each new one counts for a sixteenth.
inline constexpr int running_mean_b_scans = 16;

// The mean over the lines of a B-scan, in counts after the right shift. For one thread; measure()
// allocates nothing.
class LineMean {
public:
  explicit LineMean(int samples);

  // Count: std::uint8_t, std::uint16_t or float; counts are [line][sample].
  template <class Count> void measure(const Count* counts, int lines, int right_shift) noexcept;

  // `samples` values.
  std::span<const double> values() const { return mean_; }

private:
  std::vector<std::uint32_t> sums_;
  std::vector<double> mean_;
};

// The running mean of BackgroundMode::running.
//
// It depends on the order of the B-scans, but workers finish them in any order. So the one thread
// that distributes B-scans calls add() for each of them, in order, and passes the current mean on
// with the B-scan. This needs no lock and no waiting, gives the same result for any number of
// workers and a background for the first B-scan, and sums the lines only once. The alternatives
// lack some of that: a mean for each worker (it sees B-scans by chance), for each B-scan position
// (it takes still tissue for background), or one a volume (none for the first, and volumes
// overlap).
//
// Not thread-safe; add() allocates nothing.
class RunningBackground {
public:
  RunningBackground(const SpectrumFormat& format, int a_scans);

  // Takes the kept lines of the next B-scan (Reconstructor::reconstruct_b_scan() says what a frame
  // is) and returns the mean over it and those before, N values, unchanged until the next call.
  std::span<const float> add(std::span<const std::byte> frame) noexcept;

  // As if no B-scan had been seen.
  void reset() { b_scans_seen_ = 0; }

private:
  SpectrumFormat format_;
  int a_scans_;
  int b_scans_seen_ = 0;
  LineMean b_scan_;
  std::vector<double> mean_; // in double precision, so that a long run does not drift
  std::vector<float> values_;
};

// The running background of every frame being processed, indexed by its camera buffer.
// The thread that hands frames out calls take() for each of them, in order and before it hands the
// frame out; the worker with the frame calls of() until the frame returns to the camera. The
// hand-over and the return order the two; nothing allocates or locks.
class FrameBackgrounds {
public:
  FrameBackgrounds(RunningBackground running, int samples, int camera_buffers);

  void take(const hal::LineFrame& frame) noexcept;
  std::span<const float> of(const hal::LineFrame& frame) const noexcept;

private:
  RunningBackground running_;
  std::size_t samples_;
  std::vector<float> by_buffer_; // [buffer][sample]
};

} // namespace octascope::pipeline
