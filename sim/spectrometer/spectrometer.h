// A spectrometer, from light to counts: the forward model that the reconstruction has to undo.
//
// With N samples a line, p a pixel, m = r⁻¹(p) its position on the axis that is uniform in k, and
// d a depth in bins (a depth of d bins makes d fringes over N samples of m):
//
//   light[p] = E(p) · (reference + Σ_j a_j · R(d_j) · cos(2π·d_j·m/N + φ_j − θ(m)))
//   mean[p]  = dark[p] + gain[p] · light[p]
//   count[p] = round(mean[p] + noise[p]), kept within 0 … 2^bits − 1
//
//   noise    Gaussian, variance mean/electrons_per_count (shot) + read_noise² (in counts²)
//   E(p)     source envelope: two half Gaussians of unequal width, 1 at its peak
//   R(d)     roll-off of amplitude: sinc(d/N), a pixel's width, times the Fourier transform of a
//            Gaussian spot of FWHM w pixels, exp(−(π·w·d/N)² / (4·ln 2))
//   r[m]     chirp, (N−1)·(t − 4·bow·t·(1−t)·(1 + skew·(2t−1))), t = m/(N−1)
//   θ[m]     dispersion, quadratic·P₂(u) + cubic·P₃(u), Legendre polynomials of u = 2t − 1, which
//            a straight line fitted to the phase leaves alone
//   dark     dark_counts and a fixed pattern; gain[p] = 1 and a fixed pattern
//
// So a linearised line is x[m] = s(r[m]), and multiplying by exp(+iθ[m]) compensates. A mirror of
// amplitude a at depth d then has its peak at bin d with the level that mirror_level_db() gives.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.h"

namespace octascope::sim {

struct SpectrometerConfig {
  int samples = 1024; // N
  int significant_bits = 12;
  double reference_counts = 2100; // light of the reference arm at the envelope's peak
  double chirp_bow = 70.0 / 1024; // of the line's length
  double chirp_skew = 0.1;
  double dispersion_quadratic_rad = 25;
  double dispersion_cubic_rad = 6;
  double envelope_peak = 0.48; // position on the line, 0 … 1
  double envelope_rise = 0.21; // standard deviations below and above the peak, of the line's length
  double envelope_fall = 0.25;
  double spot_fwhm_pixels = 0.9;
  double dark_counts = 60;
  double dark_pattern_counts = 4; // rms
  double gain_pattern = 0.005;    // rms
  double electrons_per_count = 40;
  double read_noise_counts = 2; // rms
  std::uint64_t seed = 1;

  // The message names the first invalid value, with what was found and expected.
  hal::Result<> validate() const;
};

// A mirror: fringe amplitude in counts at the envelope's peak, before the roll-off.
struct Reflector {
  double depth_bin = 0;
  double amplitude_counts = 0;
  double phase_rad = 0;
};

// Immutable, so thread-safe.
class Spectrometer {
public:
  static hal::Result<Spectrometer> make(const SpectrometerConfig& config);

  const SpectrometerConfig& config() const { return config_; }
  int samples() const { return config_.samples; }
  int depths() const { return config_.samples / 2; }
  int full_scale_counts() const { return (1 << config_.significant_bits) - 1; }

  // N each, in the convention of calibration files: r[m] and θ[m].
  const std::vector<double>& true_k_positions() const { return k_positions_; }
  const std::vector<double>& true_dispersion_rad() const { return dispersion_rad_; }

  // Of a pixel: m = r⁻¹(p), θ(m), E(p), dark[p] and gain[p].
  const std::vector<double>& k_of_pixel() const { return k_of_pixel_; }
  const std::vector<double>& dispersion_of_pixel_rad() const { return dispersion_of_pixel_rad_; }
  const std::vector<double>& envelope() const { return envelope_; }
  const std::vector<double>& dark_counts() const { return dark_; }
  const std::vector<double>& gain() const { return gain_; }

  // R(d).
  double roll_off(double depth_bin) const;

  // mean[p] for some mirrors, by the formula, in double precision.
  std::vector<double> mean_counts(std::span<const Reflector> reflectors) const;

  // Level of a mirror's peak, 20·log10(|Y|/N) at its depth after the chain of linearisation, window
  // w[m] (N weights) and dispersion: a·R(d)/2 · (1/N)·Σ w[m]·E(r[m]).
  double mirror_level_db(const Reflector& mirror, std::span<const double> window) const;

private:
  explicit Spectrometer(const SpectrometerConfig& config);

  double k_position(double m) const;
  double k_of(double pixel) const;
  double dispersion_rad(double m) const;
  double envelope_at(double pixel) const;

  SpectrometerConfig config_;
  std::vector<double> k_positions_;
  std::vector<double> dispersion_rad_;
  std::vector<double> k_of_pixel_;
  std::vector<double> dispersion_of_pixel_rad_;
  std::vector<double> envelope_;
  std::vector<double> dark_;
  std::vector<double> gain_;
};

} // namespace octascope::sim
