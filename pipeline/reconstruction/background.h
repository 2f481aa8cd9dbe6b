// The background of a B-scan: what the spectrum is without interference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/line_camera.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/reconstruction/spectrum_format.h"

namespace octascope::pipeline {

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

// With very few lines the calibration's background would remove everything: a line minus its own
// mean is zero. Then puts one into `calibration` that does not (the mean over several B-scans for
// B-scans of one A-scan, none for a single line), and returns what to tell the user; else nothing.
std::optional<std::string> replace_background_of_few_lines(Calibration& calibration, int a_scans,
                                                           int b_scans);

// The background of BackgroundMode::running: the mean over the volumes before, which follows slow
// changes of the light.
//
// The mean of a single B-scan contains what is level in it (the apex of a cornea, a forceps), takes
// it away there and leaves its negative in all other A-scans, as a line through the whole B-scan.
// Over volumes a level place is a small share, and what moves by half a wavelength cancels
// (RECONSTRUCTION.md has the figures). Some lines of each B-scan are enough, each time others;
// saturated ones are left out.
//
// It depends on the order of the B-scans, but workers finish them in any order. So the one thread
// that distributes B-scans calls add() for each of them, in order, and passes the current mean on
// with the B-scan. This needs no lock and no waiting, gives the same result for any number of
// workers and a background for the first B-scan. A mean for each worker would see B-scans by
// chance, one for each B-scan position would take still tissue for background.
//
// Not thread-safe; add() allocates nothing.
class RunningBackground {
public:
  // `sweeps`: frames a volume. The first B-scans are averaged evenly, after that each new one
  // counts for 1/window().
  RunningBackground(const SpectrumFormat& format, int a_scans, int sweeps);

  // Takes some of the kept lines of the next B-scan (Reconstructor::reconstruct_b_scan() says what
  // a frame is) and returns the mean over it and those before, N values, unchanged until the next
  // call.
  std::span<const float> add(std::span<const std::byte> frame) noexcept;

  // How many B-scans it looks back: those of two volumes, and not fewer than 64.
  int window() const { return window_; }
  // Every how many lines of a B-scan are taken.
  int stride() const { return stride_; }

private:
  // Into sums_; returns the number of lines.
  template <class Count> int sum_lines_below(const Count* counts, std::uint32_t limit) noexcept;
  int sum_frame_below(std::span<const std::byte> frame, std::uint32_t limit) noexcept;

  SpectrumFormat format_;
  int a_scans_;
  int window_;
  int stride_;
  int first_ = 0; // line of the next B-scan
  int b_scans_seen_ = 0;
  std::vector<float> sums_;  // of less than 64 lines: exact for 16 bits
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
