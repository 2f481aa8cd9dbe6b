// Fixed lines in a B-scan: what is the same in every A-scan, and so no tissue.
//
// The mean over a B-scan takes a fixed pattern out, but with it what a horizontal reflector has in
// common over most of the B-scan. The minimum-variance mean A-scan does better: the B-scan is
// parted into segments of neighbouring A-scans, and for each depth the segment whose complex values
// vary least gives the pattern, its mean: there, the fixed pattern is alone. After S. Moon,
// S.-W. Lee, Z. Chen: Reference spectrum extraction and fixed-pattern noise removal in optical
// coherence tomography, Optics Express 18 (2010) 24395.
//
// A reflector that keeps amplitude and phase from A-scan to A-scan better than the noise does, as a
// perfectly flat mirror, cannot be told from a fixed line, and one that fills every segment loses
// what it has in common in the quietest of them. Tissue does neither.
//
// The chain before it is linear, so whatever constant background was subtracted from the lines
// (a recorded one, a mean, nothing) drops out: the result is the same.
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
  static constexpr int fewest_a_scans = 4; // of a segment: the variance of fewer says little

  FixedPatternMode mode = FixedPatternMode::none;
  int segments = 8;

  // ErrorCode::invalid_argument with found, expected and the remedy where there are too few
  // A-scans.
  hal::Result<> validate(int a_scans) const;
};

// Collects the complex A-scans of one B-scan and removes what is fixed. For one thread; nothing
// but the constructor allocates.
class FixedPatternRemover {
public:
  FixedPatternRemover(int segments, int a_scans, int depths);

  // `depths` complex values (re, im, re, im …) of A-scan `a`, to be filled and read.
  float* a_scan(int a) { return a_scans_.data() + stride_ * static_cast<std::size_t>(a); }

  // Takes the pattern out of the first `a_scans` A-scans, at most as many as there are room for.
  void remove(int a_scans) noexcept;

private:
  void sum_segment(int first, int last) noexcept;
  void keep_quieter_means(int a_scans, bool first_segment) noexcept;

  int segments_;
  std::size_t depths_;
  std::size_t stride_; // floats of an A-scan
  std::vector<float> a_scans_;
  std::vector<float> sums_;     // of one segment, complex, relative to its first A-scan
  std::vector<float> squares_;  // of one segment, relative likewise
  std::vector<float> variance_; // the least so far, by depth
  std::vector<float> pattern_;  // its segment's mean
  const float* origin_ = nullptr;
};

} // namespace octascope::pipeline
