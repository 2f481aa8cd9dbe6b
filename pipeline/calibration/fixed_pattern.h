// Removes fixed-pattern noise: lines that are the same in every A-scan, and so are not tissue.
//
// Subtracting the mean over a B-scan removes a fixed pattern, but also whatever a horizontal
// reflector has in common over most of the B-scan. The minimum-variance mean A-scan is better: the
// B-scan is divided into segments of neighbouring A-scans, and for each depth the pattern is the
// mean of the segment whose complex values vary least: there, the pattern is alone. After S. Moon,
// S.-W. Lee, Z. Chen: Reference spectrum extraction and fixed-pattern noise removal in optical
// coherence tomography, Optics Express 18 (2010) 24395.
//
// A reflector whose amplitude and phase vary less than the noise from A-scan to A-scan, such as a
// perfectly flat mirror, cannot be distinguished from a fixed line. A reflector in every segment
// loses its mean over the quietest one. Neither happens with tissue.
//
// The processing before this is linear, so the result does not depend on which constant background
// (recorded, mean or none) was subtracted from the lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/result.h"

namespace octascope::pipeline {

enum class FixedPatternMode : std::uint8_t { none, minimum_variance };

struct FixedPatternRemoval {
  static constexpr int fewest_segments = 2;
  static constexpr int most_segments = 64;
  static constexpr int fewest_a_scans = 4; // per segment: the variance of fewer means little

  FixedPatternMode mode = FixedPatternMode::none;
  int segments = 8;

  // ErrorCode::invalid_argument, with found, expected and the remedy: `segments` out of range, or
  // too few A-scans for them.
  hal::Result<> validate(int a_scans) const;
};

// Collects the complex A-scans of one B-scan and removes the fixed pattern. For one thread; only
// the constructor allocates.
class FixedPatternRemover {
public:
  FixedPatternRemover(int segments, int a_scans, int depths);

  // `depths` complex values (re, im, re, im …) of A-scan `a`, to be filled and read.
  float* a_scan(int a) { return a_scans_.data() + stride_ * static_cast<std::size_t>(a); }

  // Removes the pattern from the first `a_scans` A-scans, at most the constructor's number.
  void remove(int a_scans) noexcept;

private:
  void sum_segment(int first, int last) noexcept;
  void keep_quieter_means(int a_scans, bool first_segment) noexcept;

  int segments_;
  std::size_t depths_;
  std::size_t stride_; // floats of an A-scan
  std::vector<float> a_scans_;
  std::vector<float> sums_;     // of one segment, complex, relative to its first A-scan
  std::vector<float> squares_;  // likewise
  std::vector<float> variance_; // the lowest so far, by depth
  std::vector<float> pattern_;  // the mean of that segment
  const float* origin_ = nullptr;
};

} // namespace octascope::pipeline
