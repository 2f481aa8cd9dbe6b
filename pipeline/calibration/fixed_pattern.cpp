#include "pipeline/calibration/fixed_pattern.h"

#include <algorithm>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

// The values of an A-scan relative to `origin`: summed, and their squares. A fixed line may be a
// hundred thousand times what varies; relative to one of the values, no digits are lost to it.
OCTASCOPE_CPU_CLONES
void add_relative(const float* a_scan, const float* origin, std::size_t depths, float* sums,
                  float* squares) {
  for (std::size_t z = 0; z < depths; ++z) {
    const float re = a_scan[2 * z] - origin[2 * z];
    const float im = a_scan[2 * z + 1] - origin[2 * z + 1];
    sums[2 * z] += re;
    sums[2 * z + 1] += im;
    squares[z] += re * re + im * im;
  }
}

OCTASCOPE_CPU_CLONES
void subtract(const float* pattern, std::size_t floats, float* a_scan) {
  for (std::size_t i = 0; i < floats; ++i)
    a_scan[i] -= pattern[i];
}

} // namespace

hal::Result<> FixedPatternRemoval::validate(int a_scans) const {
  if (mode == FixedPatternMode::none)
    return {};
  if (segments < fewest_segments || segments > most_segments)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "fixed_pattern: segments is {}, expected {} to {}", segments, fewest_segments,
                     most_segments);
  if (a_scans / segments < fewest_a_scans)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "fixed_pattern: {} segments of {} A-scans, expected at least {} A-scans a "
                     "segment: fewer segments, or mode = \"none\"",
                     segments, a_scans, fewest_a_scans);
  return {};
}

FixedPatternRemover::FixedPatternRemover(int segments, int a_scans, int depths)
    : segments_(segments), depths_(static_cast<std::size_t>(depths)), stride_(2 * depths_),
      a_scans_(stride_ * static_cast<std::size_t>(a_scans)), sums_(stride_), squares_(depths_),
      variance_(depths_), pattern_(stride_) {}

void FixedPatternRemover::sum_segment(int first, int last) noexcept {
  std::ranges::fill(sums_, 0.0F);
  std::ranges::fill(squares_, 0.0F);
  origin_ = a_scan(first);
  for (int a = first + 1; a < last; ++a)
    add_relative(a_scan(a), origin_, depths_, sums_.data(), squares_.data());
}

void FixedPatternRemover::keep_quieter_means(int a_scans, bool first_segment) noexcept {
  const float share = 1.0F / static_cast<float>(a_scans);
  for (std::size_t z = 0; z < depths_; ++z) {
    const float re = sums_[2 * z] * share;
    const float im = sums_[2 * z + 1] * share;
    const float variance = squares_[z] * share - (re * re + im * im);
    if (!first_segment && variance >= variance_[z])
      continue;
    variance_[z] = variance;
    pattern_[2 * z] = origin_[2 * z] + re;
    pattern_[2 * z + 1] = origin_[2 * z + 1] + im;
  }
}

void FixedPatternRemover::remove(int a_scans) noexcept {
  for (int s = 0; s < segments_; ++s) {
    const int first = a_scans * s / segments_;
    const int last = a_scans * (s + 1) / segments_;
    if (first == last)
      continue;
    sum_segment(first, last);
    keep_quieter_means(last - first, s == 0);
  }
  for (int a = 0; a < a_scans; ++a)
    subtract(pattern_.data(), stride_, a_scan(a));
}

} // namespace octascope::pipeline
