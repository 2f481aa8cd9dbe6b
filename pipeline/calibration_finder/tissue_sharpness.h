// Dispersion without a mirror: the phase that makes an image of tissue sharpest.
//
// Sharpness is Σ I² / (Σ I)² with I = |Y|² over depth and A-scans. It rises when speckle and
// surfaces are spread over fewer bins, and does not depend on brightness.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pipeline/calibration/calibration.h"

namespace octascope::pipeline {

// Some A-scans of tissue, linearised and windowed once, so that many phases can be tried.
// Use it from one thread at a time.
class TissueSharpness {
public:
  // Positions, interpolation and window are the calibration's; its dispersion is not used.
  explicit TissueSharpness(const Calibration& calibration);
  ~TissueSharpness();

  // One B-scan, [line][sample] in any unit, all finite; its mean is the background. At most 50 of
  // its lines, evenly chosen, are kept.
  void add_b_scan(std::span<const double> counts);

  // With θ[m], N values; empty: none.
  double measure(std::span<const double> theta_rad);

private:
  struct State;
  std::unique_ptr<State> state_;
};

struct TissueDispersion {
  double quadratic_rad = 0; // θ = quadratic·P₂(v) + cubic·P₃(v), v = 2m/(N−1) − 1, Legendre
  double cubic_rad = 0;
  std::vector<double> theta_rad;
  std::vector<double> unit_polynomial_rad; // the same as Σ d_i (m/(N−1))^i
  double sharpness_before = 0;             // with θ = 0
  double sharpness_after = 0;
};

// Searches ±`widest_rad` from coarse to fine: first quadratic, then cubic, then both again.
TissueDispersion find_tissue_dispersion(TissueSharpness& sharpness, int samples,
                                        double widest_rad = 100);

} // namespace octascope::pipeline
