#include "sim/spectrometer/spectrometer.h"

#include <cmath>
#include <numbers>

#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

constexpr double pi = std::numbers::pi;

struct Bound {
  const char* name;
  double found;
  double lowest;
  double highest;
};

} // namespace

hal::Result<> SpectrometerConfig::validate() const {
  if (samples < 16 || samples > 65536)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "spectrometer: samples is {}, expected 16 to 65536", samples);
  const double full_scale = std::ldexp(1.0, significant_bits);
  // r[m] rises where 4·bow·(1 + skew) < 1, which these bounds ensure.
  const Bound bounds[] = {
      {"significant_bits", static_cast<double>(significant_bits), 8, 16},
      {"reference_counts", reference_counts, 0, full_scale},
      {"chirp_bow", chirp_bow, -0.2, 0.2},
      {"chirp_skew", chirp_skew, -0.2, 0.2},
      {"dispersion_quadratic_rad", dispersion_quadratic_rad, -1000, 1000},
      {"dispersion_cubic_rad", dispersion_cubic_rad, -1000, 1000},
      {"envelope_peak", envelope_peak, 0, 1},
      {"envelope_rise", envelope_rise, 0.01, 100},
      {"envelope_fall", envelope_fall, 0.01, 100},
      {"spot_fwhm_pixels", spot_fwhm_pixels, 0, 20},
      {"dark_counts", dark_counts, 0, full_scale},
      {"dark_pattern_counts", dark_pattern_counts, 0, full_scale},
      {"gain_pattern", gain_pattern, 0, 0.2},
      {"electrons_per_count", electrons_per_count, 1e-3, 1e9},
      {"read_noise_counts", read_noise_counts, 0, full_scale},
  };
  for (const Bound& bound : bounds)
    if (!(bound.found >= bound.lowest && bound.found <= bound.highest))
      return hal::fail(hal::ErrorCode::invalid_argument,
                       "spectrometer: {} is {}, expected {} to {}", bound.name, bound.found,
                       bound.lowest, bound.highest);
  return {};
}

hal::Result<Spectrometer> Spectrometer::make(const SpectrometerConfig& config) {
  HAL_CHECK(config.validate());
  return Spectrometer{config};
}

Spectrometer::Spectrometer(const SpectrometerConfig& config) : config_(config) {
  const auto n = static_cast<std::size_t>(config.samples);
  const GaussianTable patterns(hash(config.seed, 0xda7c), 16, n);
  const std::span<const float> dark_pattern = patterns.run(1, n);
  const std::span<const float> gain_pattern = patterns.run(2, n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto position = static_cast<double>(i);
    k_positions_.push_back(k_position(position));
    dispersion_rad_.push_back(dispersion_rad(position));
    k_of_pixel_.push_back(k_of(position));
    dispersion_of_pixel_rad_.push_back(dispersion_rad(k_of_pixel_.back()));
    envelope_.push_back(envelope_at(position));
    dark_.push_back(config.dark_counts +
                    config.dark_pattern_counts * static_cast<double>(dark_pattern[i]));
    gain_.push_back(1 + config.gain_pattern * static_cast<double>(gain_pattern[i]));
  }
}

double Spectrometer::k_position(double m) const {
  const double last = config_.samples - 1;
  const double t = m / last;
  return last * (t - 4 * config_.chirp_bow * t * (1 - t) * (1 + config_.chirp_skew * (2 * t - 1)));
}

double Spectrometer::k_of(double pixel) const {
  // Bisection: r(m) rises from 0 to N−1, and 60 halvings exhaust a double.
  double below = 0;
  double above = config_.samples - 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (below + above) / 2;
    (k_position(middle) < pixel ? below : above) = middle;
  }
  return (below + above) / 2;
}

double Spectrometer::dispersion_rad(double m) const {
  const double u = 2 * m / (config_.samples - 1) - 1;
  return config_.dispersion_quadratic_rad * (3 * u * u - 1) / 2 +
         config_.dispersion_cubic_rad * (5 * u * u * u - 3 * u) / 2;
}

double Spectrometer::envelope_at(double pixel) const {
  const double distance = pixel / (config_.samples - 1) - config_.envelope_peak;
  const double width = distance < 0 ? config_.envelope_rise : config_.envelope_fall;
  return std::exp(-0.5 * distance * distance / (width * width));
}

double Spectrometer::roll_off(double depth_bin) const {
  const double cycles_per_pixel = depth_bin / config_.samples;
  const double spot = pi * config_.spot_fwhm_pixels * cycles_per_pixel;
  const double x = pi * cycles_per_pixel;
  const double pixel = std::abs(x) < 1e-9 ? 1 : std::sin(x) / x;
  return pixel * std::exp(-spot * spot / (4 * std::numbers::ln2));
}

std::vector<double> Spectrometer::mean_counts(std::span<const Reflector> reflectors) const {
  std::vector<double> counts(k_of_pixel_.size());
  for (std::size_t p = 0; p < counts.size(); ++p) {
    double interference = 0;
    for (const Reflector& reflector : reflectors)
      interference += reflector.amplitude_counts * roll_off(reflector.depth_bin) *
                      std::cos(2 * pi * reflector.depth_bin * k_of_pixel_[p] / config_.samples +
                               reflector.phase_rad - dispersion_of_pixel_rad_[p]);
    counts[p] = dark_[p] + gain_[p] * envelope_[p] * (config_.reference_counts + interference);
  }
  return counts;
}

double Spectrometer::mirror_level_db(const Reflector& mirror,
                                     std::span<const double> window) const {
  double sum = 0;
  for (std::size_t m = 0; m < window.size(); ++m)
    sum += window[m] * envelope_at(k_positions_[m]);
  return 20 * std::log10(mirror.amplitude_counts * roll_off(mirror.depth_bin) / 2 * sum /
                         config_.samples);
}

} // namespace octascope::sim
