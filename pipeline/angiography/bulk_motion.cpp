#include "pipeline/angiography/bulk_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "pipeline/angiography/kernel_sums.h"

namespace octascope::pipeline {

namespace {

constexpr int compared_a_scans = 20;
constexpr int fewest_depths = 48;
// A-scans nearer than this have much of their speckle in common: beams overlap.
constexpr float independent_a_scans = 2.4F;
// The squared modulus of the coherence at the best lag, at which no other A-scan is tried.
constexpr float enough_coherence = 0.8F;
constexpr float tiny = 1e-30F;

float squared(float real, float imaginary) {
  return real * real + imaginary * imaginary;
}

// Above the greatest of two hundred lags of what has nothing in common, but for one in a hundred
// thousand: the sum of n exponentials is n ± √n with a long tail, and overlaps of what is bright make
// the floor uneven. Measured on other places and on motion beyond the limits: at most 2.9 where 24
// A-scans are compared and 11 of 4 that overlap. Tissue 5 dB above the noise has 10 of 24.
float least_contrast_of(int a_scans, int step) {
  const float apart = std::max(independent_a_scans, static_cast<float>(step));
  return 1 + 15 / std::sqrt(std::max(1.0F, static_cast<float>(a_scans) / apart));
}

} // namespace

float AxialCoherence::independent_samples(int bins) const {
  const auto n = static_cast<float>(bins);
  float pairs = n;
  for (int d = 1; d < std::min(bins, static_cast<int>(correlation.size())); ++d) {
    const float c = correlation[static_cast<std::size_t>(d)];
    pairs += 2 * static_cast<float>(bins - d) * c * c;
  }
  return n * n / pairs;
}

BulkMotionEstimator::BulkMotionEstimator(int a_scans, int depths)
    : a_scans_(a_scans), depths_(depths), step_(std::max(1, a_scans / compared_a_scans)),
      least_contrast_(least_contrast_of(a_scans, step_)),
      first_(2 * static_cast<std::size_t>(depths)), second_(first_) {}

void BulkMotionEstimator::split(const PackedBin* line, float* parts) const noexcept {
  split_parts(line, 0, depths_, parts, parts + depths_);
}

AxialCoherence BulkMotionEstimator::coherence(const PackedBin* sweep) noexcept {
  AxialCoherence result;
  if (depths_ < fewest_depths)
    return result;
  Correlation real{};
  Correlation imaginary{};
  for (int a = step_ / 2; a < a_scans_; a += step_) {
    split(sweep + static_cast<std::ptrdiff_t>(a) * depths_, first_.data());
    correlate_lags(first_.data(), first_.data(), depths_, real, imaginary);
  }
  const float power = real[zero_lag];
  if (!(power > tiny))
    return result;
  // Y(z)·conj(Y(z + 1)) turns backwards from bin to bin.
  const std::complex<float> turn{real[zero_lag + 1], -imaginary[zero_lag + 1]};
  if (std::abs(turn) > tiny)
    result.carrier = turn / std::abs(turn);
  for (std::size_t d = 1; d < result.correlation.size(); ++d)
    result.correlation[d] =
        std::min(1.0F, std::hypot(real[zero_lag + d], imaginary[zero_lag + d]) / power);
  return result;
}

BulkMotionEstimator::Peak BulkMotionEstimator::axial_peak(const PackedBin* first,
                                                          const PackedBin* second,
                                                          int lateral) noexcept {
  Correlation sum{};
  float most = 0; // of a lag at which both were alike
  for (int a = step_ / 2; a < a_scans_; a += step_) {
    if (a + lateral < 0 || a + lateral >= a_scans_)
      continue;
    if (a + lateral + step_ < a_scans_ && a + step_ < a_scans_) {
      fetch_line(first + static_cast<std::ptrdiff_t>(a + step_) * depths_, depths_);
      fetch_line(second + static_cast<std::ptrdiff_t>(a + lateral + step_) * depths_, depths_);
    }
    split(first + static_cast<std::ptrdiff_t>(a) * depths_, first_.data());
    split(second + static_cast<std::ptrdiff_t>(a + lateral) * depths_, second_.data());
    Correlation real{};
    Correlation imaginary{};
    correlate_lags(first_.data(), second_.data(), depths_, real, imaginary);
    const float amplitudes = std::sqrt(sum_of_squares(first_.data(), 2 * depths_) *
                                       sum_of_squares(second_.data(), 2 * depths_));
    most += amplitudes;
    for (std::size_t s = 0; s < sum.size(); ++s)
      sum[s] += squared(real[s], imaginary[s]) / (amplitudes + tiny);
  }
  const auto allowed = std::span{sum}.subspan(zero_lag - most_axial_bins, 2 * most_axial_bins + 1);
  const auto top = std::max_element(allowed.begin(), allowed.end()) - allowed.begin() + zero_lag -
                   most_axial_bins;
  float floor = 0;
  float apart = 0;
  for (int s = 0; s < lags; ++s) {
    if (std::abs(s - static_cast<int>(top)) > 4) {
      floor += sum[static_cast<std::size_t>(s)];
      ++apart;
    }
  }
  floor /= apart;
  const auto above = [&](std::ptrdiff_t s) { return sum[static_cast<std::size_t>(s)] - floor; };
  Peak peak;
  peak.height = above(top);
  peak.contrast = (peak.height + floor) / (floor + tiny);
  peak.axial_bins = static_cast<float>(top - zero_lag);
  // A Hann window's neighbours are a fifth of the peak or more; less is chance, of another window.
  const float least = 0.1F * peak.height;
  if (peak.height > 0) {
    const float before = std::log(std::max(above(top - 1), least));
    const float here = std::log(peak.height);
    const float after = std::log(std::max(above(top + 1), least));
    const float curvature = before - 2 * here + after;
    float between = 0;
    if (curvature < 0)
      between = std::clamp(0.5F * (before - after) / curvature, -0.5F, 0.5F);
    peak.axial_bins += between;
    peak.coherence = std::exp(here - 0.25F * (before - after) * between) / (most + tiny);
  }
  return peak;
}

BulkMotion BulkMotionEstimator::estimate(const PackedBin* first, const PackedBin* second) noexcept {
  if (depths_ < fewest_depths)
    return {};
  Peak best = axial_peak(first, second, 0);
  // So alike that an A-scan further there is nothing to gain.
  const bool found_here = best.coherence > enough_coherence && best.contrast >= 2 * least_contrast_;
  int lateral = 0;
  const auto try_lateral = [&](int l) {
    const Peak peak = axial_peak(first, second, l);
    if (peak.height <= best.height)
      return false;
    best = peak;
    lateral = l;
    return true;
  };
  // Neighbours first: mostly the sample has not moved by as much as an A-scan.
  if (!found_here && (try_lateral(-1) || best.contrast < 2 * least_contrast_))
    for (int l = -2; l >= -most_lateral_a_scans; --l)
      try_lateral(l);
  if (!found_here && (try_lateral(1) || best.contrast < 2 * least_contrast_))
    for (int l = 2; l <= most_lateral_a_scans; ++l)
      try_lateral(l);
  BulkMotion motion;
  motion.found = best.contrast >= least_contrast_ &&
                 std::abs(best.axial_bins) < static_cast<float>(most_axial_bins);
  if (motion.found) {
    motion.axial_bins = best.axial_bins;
    motion.lateral_a_scans = lateral;
  }
  return motion;
}

FractionalShift FractionalShift::by(float bins, const AxialCoherence& coherence) {
  constexpr float negligible = 0.05F;
  FractionalShift shift;
  const float nearest = std::round(bins);
  if (std::abs(bins - nearest) < negligible) {
    shift.whole = static_cast<int>(nearest);
    return shift;
  }
  const float below = std::floor(bins);
  shift.whole = static_cast<int>(below);
  shift.interpolates = true;
  const float fraction = bins - below;
  std::array<float, 6> weights{};
  float sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const float x = std::numbers::pi_v<float> * (static_cast<float>(i) - 2 - fraction);
    const float window = std::cos(x / 6);
    weights[i] = std::sin(x) / x * window * window;
    sum += weights[i];
  }
  std::complex<float> turn = coherence.carrier * coherence.carrier;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    shift.taps[i] = turn * (weights[i] / sum);
    turn *= std::conj(coherence.carrier);
  }
  return shift;
}

int FractionalShift::first(int depths) const {
  return std::clamp(-whole + (interpolates ? 2 : 0), 0, depths);
}

int FractionalShift::last(int depths) const {
  return std::clamp(depths - whole - (interpolates ? 3 : 0), first(depths), depths);
}

void FractionalShift::apply(const PackedBin* line, int begin, int end, float* real,
                            float* imaginary) const noexcept {
  if (interpolates)
    interpolate(line + whole - 2, taps, begin, end, real, imaginary);
  else
    split_parts(line + whole, begin, end, real, imaginary);
}

} // namespace octascope::pipeline
