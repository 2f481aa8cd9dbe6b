// The background of a B-scan: what the spectrum is without interference.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/calibration.h"

namespace octascope::pipeline {

// How many B-scans the running mean looks back: the first ones are averaged evenly, after that
// each new one counts for a sixteenth.
inline constexpr int running_mean_b_scans = 16;

// One worker's background, in counts after the right shift. Not thread-safe: with
// BackgroundMode::running each worker averages the B-scans that it sees itself. update() allocates
// nothing.
class Background {
public:
  Background(BackgroundMode mode, int samples, const std::vector<float>& recorded);

  // Takes the kept lines of a B-scan ([line][sample]) and makes values() right for it.
  template <class Count>
  void update(std::span<const Count> counts, int lines, int right_shift) noexcept;

  // `samples` values.
  const float* values() const { return values_.data(); }

  // Forgets the B-scans seen so far (running).
  void reset() { b_scans_seen_ = 0; }

private:
  BackgroundMode mode_;
  int samples_;
  int b_scans_seen_ = 0;
  std::vector<float> values_;
  std::vector<std::uint32_t> sum_;
  std::vector<double> float_sum_;
};

} // namespace octascope::pipeline
