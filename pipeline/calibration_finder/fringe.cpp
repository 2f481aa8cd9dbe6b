#include "pipeline/calibration_finder/fringe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>

#include "pipeline/calibration_finder/gaussian_smoothing.h"
#include "pipeline/calibration_finder/line_transform.h"

namespace octascope::pipeline {

namespace {

using hal::ErrorCode;
using Complex = std::complex<double>;
constexpr double two_pi = 2 * std::numbers::pi;
constexpr int highest_degree = 10;
constexpr int refinements = 6;
constexpr double faintest = 0.04; // of the highest amplitude: below, a pixel is not believed

struct Band {
  std::size_t first = 0;
  std::size_t last = 0;
};

// What the brightest run of pixels is, given amplitudes.
Band bright_run(const std::vector<double>& amplitude, double threshold) {
  const auto peak = static_cast<std::size_t>(std::max_element(amplitude.begin(), amplitude.end()) -
                                             amplitude.begin());
  Band run{peak, peak};
  while (run.first > 0 && amplitude[run.first - 1] >= threshold)
    --run.first;
  while (run.last + 1 < amplitude.size() && amplitude[run.last + 1] >= threshold)
    ++run.last;
  return run;
}

// Unwraps from the brightest pixel outwards, where a step is least likely to be noise.
void unwrap(std::vector<double>& phase, std::size_t from) {
  const auto follow = [&](std::size_t here, std::size_t before) {
    phase[here] -= two_pi * std::round((phase[here] - phase[before]) / two_pi);
  };
  for (std::size_t p = from + 1; p < phase.size(); ++p)
    follow(p, p - 1);
  for (std::size_t p = from; p-- > 0;)
    follow(p, p + 1);
}

class FringeFinder {
public:
  FringeFinder(std::span<const double> spectrum, std::string_view name)
      : name_(name), spectrum_(spectrum.begin(), spectrum.end()) {}

  hal::Result<Fringe> find();

private:
  hal::Result<> check() const;
  hal::Result<Band> find_band();
  SmoothFit first_phase(const Band& band);
  SmoothFit refine(const SmoothCurve& phase);
  tl::unexpected<hal::Error> refuse(std::string_view words) const {
    return hal::fail(ErrorCode::bad_data, fmt::format("{}: {}", name_, words));
  }

  std::string_view name_;
  std::vector<double> spectrum_; // its slow part is taken away after the check
  std::vector<Complex> transform_;
  std::vector<double> measured_;
  std::vector<double> amplitude_;
  Band bright_;
  double noise_ = 0;
};

hal::Result<> FringeFinder::check() const {
  if (spectrum_.size() < fewest_fringe_samples)
    return refuse(fmt::format("has {} samples, expected at least {}", spectrum_.size(),
                              fewest_fringe_samples));
  for (std::size_t p = 0; p < spectrum_.size(); ++p) {
    if (!std::isfinite(spectrum_[p]))
      return refuse(fmt::format("sample {} is {}, expected a finite number", p, spectrum_[p]));
  }
  const auto [lowest, highest] = std::minmax_element(spectrum_.begin(), spectrum_.end());
  if (*lowest == *highest)
    return refuse(fmt::format("no fringe: all samples are {}", *lowest));
  return {};
}

// The band of the transform that holds the fringe: around the highest peak, as far as it stands out
// of the noise.
hal::Result<Band> FringeFinder::find_band() {
  const std::size_t n = spectrum_.size();
  LineTransform transform{n, LineTransform::Direction::forward};
  for (std::size_t p = 0; p < n; ++p)
    transform.values()[p] =
        spectrum_[p] *
        (0.5 - 0.5 * std::cos(two_pi * (static_cast<double>(p) + 0.5) / static_cast<double>(n)));
  transform.run();
  transform_.assign(transform.values().begin(), transform.values().end());
  std::vector<double> power(n / 2);
  for (std::size_t k = 0; k < power.size(); ++k)
    power[k] = std::norm(transform_[k]);
  std::fill_n(power.begin(), lowest_fringe_bin, 0.0);
  const std::vector<double> smooth = smooth_gaussian(power, 1.5);
  const auto peak = static_cast<std::size_t>(
      std::max_element(smooth.begin() + lowest_fringe_bin, smooth.end()) - smooth.begin());
  std::vector<double> sorted(power.begin() + lowest_fringe_bin, power.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  constexpr double least_ratio = 30; // noise alone reaches about 8
  const double ratio = smooth[peak] / std::max(*middle, 1e-300);
  if (ratio < least_ratio)
    return refuse(fmt::format("no fringe: the highest peak (bin {}) is {:.1f} dB above the median "
                              "of the transform, expected at least {:.1f} dB",
                              peak, 10 * std::log10(std::max(ratio, 1e-30)),
                              10 * std::log10(least_ratio)));
  const double threshold = std::max(2e-3 * smooth[peak], std::min(4 * *middle, smooth[peak] / 10));
  Band band{peak, peak};
  while (band.first > lowest_fringe_bin && smooth[band.first] > threshold)
    --band.first;
  while (band.last + 1 < smooth.size() && smooth[band.last] > threshold)
    ++band.last;
  return band;
}

SmoothFit FringeFinder::first_phase(const Band& band) {
  const std::size_t n = spectrum_.size();
  LineTransform inverse{n, LineTransform::Direction::inverse};
  std::fill(inverse.values().begin(), inverse.values().end(), Complex{});
  std::copy(transform_.begin() + static_cast<std::ptrdiff_t>(band.first),
            transform_.begin() + static_cast<std::ptrdiff_t>(band.last) + 1,
            inverse.values().begin() + static_cast<std::ptrdiff_t>(band.first));
  inverse.run();
  measured_.assign(n, 0.0);
  amplitude_.assign(n, 0.0);
  for (std::size_t p = 0; p < n; ++p) {
    measured_[p] = std::arg(inverse.values()[p]);
    amplitude_[p] = std::abs(inverse.values()[p]);
  }
  const auto peak = std::max_element(amplitude_.begin(), amplitude_.end());
  const double highest = *peak;
  unwrap(measured_, static_cast<std::size_t>(peak - amplitude_.begin()));
  bright_ = bright_run(amplitude_, 0.15 * highest);
  // At least an eighth of the line, so that a curve can be put through it at all.
  bright_.first = bright_.first > n / 16
                      ? std::min(bright_.first, bright_.last - std::min(bright_.last, n / 8))
                      : 0;
  bright_.last = std::max(bright_.last, std::min(n - 1, bright_.first + n / 8));
  std::vector<double> weights(n);
  std::transform(amplitude_.begin(), amplitude_.end(), weights.begin(),
                 [](double a) { return a * a; });
  return fit_smooth_curve(measured_, weights, bright_.first, bright_.last, 6,
                          static_cast<double>(n) / static_cast<double>(band.last - band.first + 1));
}

// One step of the local fits described in the header.
SmoothFit FringeFinder::refine(const SmoothCurve& phase) {
  const std::size_t n = spectrum_.size();
  double slowest = two_pi;
  for (std::size_t p = bright_.first; p <= bright_.last; ++p)
    slowest = std::min(slowest, phase.slope_at(static_cast<double>(p)));
  // Not below a fringe and a half for each side, so that the fit tells its three terms apart.
  const double sigma =
      std::clamp(0.6 * two_pi / std::max(slowest, 1e-3), 4.0, static_cast<double>(n) / 12);

  std::array<std::vector<double>, 8> moments; // c, s, cc, cs, ss, y, yc, ys
  for (auto& moment : moments)
    moment.resize(n);
  std::vector<double> predicted(n);
  for (std::size_t p = 0; p < n; ++p) {
    predicted[p] = phase.at(static_cast<double>(p));
    const double c = std::cos(predicted[p]);
    const double s = std::sin(predicted[p]);
    const double y = spectrum_[p];
    const std::array<double, 8> terms{c, s, c * c, c * s, s * s, y, y * c, y * s};
    for (std::size_t i = 0; i < terms.size(); ++i)
      moments[i][p] = terms[i];
  }
  for (auto& moment : moments)
    moment = smooth_gaussian(moment, sigma);

  double unexplained = 0;
  std::vector<Complex> local(n);
  for (std::size_t p = 0; p < n; ++p) {
    const auto m = [&](std::size_t i) { return moments[i][p]; };
    // The constant is eliminated: covariances remain.
    const double cc = m(2) - m(0) * m(0);
    const double cs = m(3) - m(0) * m(1);
    const double ss = m(4) - m(1) * m(1);
    const double yc = m(6) - m(5) * m(0);
    const double ys = m(7) - m(5) * m(1);
    const double determinant = std::max(cc * ss - cs * cs, 1e-6);
    const double a = (yc * ss - ys * cs) / determinant;
    const double b = (ys * cc - yc * cs) / determinant;
    local[p] = {a, -b};
    const double residual = spectrum_[p] - m(5) - a * (std::cos(predicted[p]) - m(0)) -
                            b * (std::sin(predicted[p]) - m(1));
    unexplained += residual * residual;
    amplitude_[p] = std::hypot(a, b);
  }
  noise_ = std::sqrt(unexplained / static_cast<double>(n));

  const auto peak = std::max_element(amplitude_.begin(), amplitude_.end());
  const double averaged = 3.5 * sigma; // pixels, by the local fit
  // A phase that is good to a quarter of a radian is still unwrapped safely, and says more about
  // its pixel than the curve's continuation; the weights see to it that it says it softly.
  const double uncertain = 4 * noise_ * std::sqrt(2 / averaged);
  bright_ = bright_run(amplitude_, std::max(faintest * *peak, uncertain));
  for (std::size_t p = 0; p < n; ++p)
    measured_[p] = std::arg(local[p]);
  unwrap(measured_, static_cast<std::size_t>(peak - amplitude_.begin()));
  std::vector<double> weights(n);
  for (std::size_t p = 0; p < n; ++p) {
    measured_[p] += predicted[p];
    weights[p] = amplitude_[p] * amplitude_[p];
  }
  return fit_smooth_curve(measured_, weights, bright_.first, bright_.last, highest_degree,
                          averaged);
}

hal::Result<Fringe> FringeFinder::find() {
  HAL_CHECK(check());
  const std::size_t n = spectrum_.size();
  spectrum_ = remove_slow_part(spectrum_);
  HAL_TRY(const auto band, find_band());
  SmoothFit fit = first_phase(band);
  for (int i = 0; i < refinements; ++i) {
    fit = refine(fit.curve);
    const std::size_t bright = bright_.last - bright_.first + 1;
    if (bright < std::max<std::size_t>(n / 8, 2 * highest_degree))
      return refuse(fmt::format("no clear fringe: only pixels {} to {} are bright enough, expected "
                                "at least {} of {}",
                                bright_.first, bright_.last, n / 8, n));
  }
  constexpr double most_residual_rad = 0.5;
  if (fit.rms > most_residual_rad)
    return refuse(fmt::format("no clear fringe: its phase scatters by {:.2f} rad about a smooth "
                              "curve, expected at most {:.2f}",
                              fit.rms, most_residual_rad));
  for (std::size_t p = bright_.first + 1; p <= bright_.last; ++p) {
    const auto x = static_cast<double>(p);
    if (fit.curve.at(x) <= fit.curve.at(x - 1))
      return refuse(fmt::format("the fringe's phase does not rise from pixel {} to {}", p - 1, p));
  }
  return Fringe{fit.curve, measured_, amplitude_, bright_.first, bright_.last, noise_, fit.rms};
}

} // namespace

std::vector<double> remove_slow_part(std::span<const double> spectrum) {
  std::vector<double> residual =
      smooth_gaussian(spectrum, 0.033 * static_cast<double>(spectrum.size()));
  std::transform(spectrum.begin(), spectrum.end(), residual.begin(), residual.begin(),
                 std::minus<>{});
  return residual;
}

hal::Result<Fringe> find_fringe(std::span<const double> spectrum, std::string_view name) {
  return FringeFinder{spectrum, name}.find();
}

} // namespace octascope::pipeline
