// How far the sample moved as a whole between two sweeps of one B-scan, and the bins without that.
//
// The estimate correlates complex bins along depth: R(l, s) = Σ over some A-scans a of
// |Σ_z Y1(a, z)·conj(Y2(a + l, z + s))|², each A-scan divided by its own amplitudes. Squared moduli
// need no knowledge of the phase of the motion, and speckle leaves no plateau below the peak, as it
// does in the correlation of intensities. The peak between bins is that of a Gaussian through three
// values, which is what a Hann window's peak is nearly.
//
// Bins are shifted by a windowed sinc of 6 taps about the carrier: the spectrum's centre, which is
// measured as the phase from bin to bin. What is left is an unknown phase, which bulk phases take.
#pragma once

#include <array>
#include <complex>
#include <vector>

#include "pipeline/volume/packed_bin.h"

namespace octascope::pipeline {

struct BulkMotion {
  float axial_bins = 0; // what is at depth z of the first sweep is at z + axial_bins of the second
  int lateral_a_scans = 0; // likewise; fractions are not corrected
  bool found = true;       // the two have something in common, within the limits
};

// How bins of one A-scan hang together along depth. It is the spectral window's, so that signal
// and noise share it. Unmeasured it is that of a Hann window, without zero-padding.
struct AxialCoherence {
  std::complex<float> carrier{-1, 0}; // from one bin to the next: of modulus 1
  // Modulus at distances of 0 to 4 bins.
  std::array<float, 5> correlation{1, 2.0F / 3, 1.0F / 6, 0, 0};

  // How many independent samples `bins` neighbouring ones are worth in a mean of products.
  float independent_samples(int bins) const;
};

// Sweeps are [a][z], depth fastest. Buffers are allocated once; from one thread at a time.
class BulkMotionEstimator {
public:
  static constexpr int most_axial_bins = 14;
  static constexpr int most_lateral_a_scans = 3;

  BulkMotionEstimator(int a_scans, int depths);

  // B-scans of less than 48 depths are too short to compare: no motion.
  BulkMotion estimate(const PackedBin* first, const PackedBin* second) noexcept;
  // Unmeasured of such, and of a sweep without power.
  AxialCoherence coherence(const PackedBin* sweep) noexcept;

private:
  static constexpr int lags = 32; // −16 to +15
  static constexpr int zero_lag = lags / 2;
  using Correlation = std::array<float, lags>;

  struct Peak {
    float axial_bins = 0;
    float height = 0; // above the floor
    float contrast = 0;
    float coherence = 0; // squared modulus: 1 where both are alike
  };

  // Over A-scans that both sweeps have. Sums of complex products by lag, one A-scan after another.
  void split(const PackedBin* line, float* parts) const noexcept;
  Peak axial_peak(const PackedBin* first, const PackedBin* second, int lateral) noexcept;

  int a_scans_;
  int depths_;
  int step_; // between the A-scans that are compared
  float least_contrast_;
  std::vector<float> first_; // one A-scan: real parts, then imaginary ones
  std::vector<float> second_;
};

// Six complex factors that shift bins by a fraction of one.
struct FractionalShift {
  int whole = 0; // floor of the shift
  bool interpolates = false;
  std::array<std::complex<float>, 6> taps{};

  // Shifts below a twentieth of a bin cost less than their correction: they are none.
  static FractionalShift by(float bins, const AxialCoherence& coherence);

  // real[z] + i·imaginary[z] = line(z + shift), for z from `begin` to `end`, which must stay within
  // first(depths) and last(depths).
  void apply(const PackedBin* line, int begin, int end, float* real,
             float* imaginary) const noexcept;
  int first(int depths) const; // the depths that the shifted line has
  int last(int depths) const;
};

} // namespace octascope::pipeline
