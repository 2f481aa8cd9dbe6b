#include "pipeline/calibration_finder/lamp_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pipeline/calibration/k_linearisation.h"
#include "pipeline/calibration_finder/gaussian_smoothing.h"

namespace octascope::pipeline {

namespace {

using hal::ErrorCode;
constexpr std::size_t fewest_lines = 3;

struct Peak {
  double pixel = 0;
  double height = 0;
};

double median(std::vector<double> values) {
  const std::size_t middle = values.size() / 2;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(middle),
                   values.end());
  return values[middle];
}

hal::Result<> check_lines(std::span<const double> lines_nm) {
  if (lines_nm.size() < fewest_lines)
    return hal::fail(ErrorCode::invalid_argument,
                     "{} emission lines are given, expected at least {}", lines_nm.size(),
                     fewest_lines);
  const bool rising = lines_nm.back() > lines_nm.front();
  for (std::size_t i = 0; i < lines_nm.size(); ++i) {
    if (!std::isfinite(lines_nm[i]) || lines_nm[i] <= 0)
      return hal::fail(ErrorCode::invalid_argument,
                       "emission line {} is {} nm, expected more than 0", i, lines_nm[i]);
    if (i > 0 && (rising ? lines_nm[i] <= lines_nm[i - 1] : lines_nm[i] >= lines_nm[i - 1]))
      return hal::fail(ErrorCode::invalid_argument,
                       "emission line {} is {} nm after {} nm, expected them in the order of the "
                       "pixels, rising or falling",
                       i, lines_nm[i], lines_nm[i - 1]);
  }
  return {};
}

// Maxima of the lightly smoothed spectrum above the noise, highest first, none on the slope of a
// higher one.
std::vector<Peak> find_peaks(const std::vector<double>& level, double threshold) {
  const std::vector<double> smooth = smooth_gaussian(level, 1);
  std::vector<Peak> peaks;
  for (std::size_t p = 2; p + 2 < level.size(); ++p) {
    if (smooth[p] < threshold || smooth[p] < smooth[p - 1] || smooth[p] <= smooth[p + 1])
      continue;
    const double half = smooth[p] / 2;
    std::size_t left = p;
    while (left > 0 && smooth[left - 1] > half && smooth[left - 1] <= smooth[p])
      --left;
    std::size_t right = p;
    while (right + 1 < level.size() && smooth[right + 1] > half && smooth[right + 1] <= smooth[p])
      ++right;
    const bool own_summit = (left == 0 || smooth[left - 1] <= half) &&
                            (right + 1 == level.size() || smooth[right + 1] <= half);
    if (!own_summit)
      continue;
    double sum = 0;
    double moment = 0;
    for (std::size_t q = left; q <= right; ++q) {
      sum += smooth[q] - half;
      moment += (smooth[q] - half) * static_cast<double>(q);
    }
    peaks.push_back({sum > 0 ? moment / sum : static_cast<double>(p), smooth[p]});
  }
  std::ranges::sort(peaks, [](auto a, auto b) { return a.height > b.height; });
  return peaks;
}

// The coefficients of Σ a_i x^i through `degree` + 1 or more points, by least squares.
std::vector<double> fit_polynomial(const std::vector<double>& x, std::span<const double> y,
                                   std::size_t degree) {
  // Orthogonal polynomials on the points (Forsythe), gathered into powers: no matrix to solve.
  const std::size_t n = x.size();
  std::vector<double> result(degree + 1);
  std::vector<double> before(degree + 1);
  std::vector<double> here(degree + 1);
  here[0] = 1;
  const auto at = [&](const std::vector<double>& c, double v) {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;)
      sum = sum * v + c[i];
    return sum;
  };
  double norm_before = 1;
  for (std::size_t k = 0; k <= degree; ++k) {
    double norm = 0;
    double along = 0;
    double shift = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double q = at(here, x[i]);
      norm += q * q;
      along += q * y[i];
      shift += q * q * x[i];
    }
    for (std::size_t c = 0; c <= degree; ++c)
      result[c] += along / norm * here[c];
    std::vector<double> next(degree + 1);
    for (std::size_t c = 0; c <= degree; ++c)
      next[c] = (c > 0 ? here[c - 1] : 0) - shift / norm * here[c] -
                (k > 0 ? norm / norm_before * before[c] : 0);
    before = std::exchange(here, std::move(next));
    norm_before = norm;
  }
  return result;
}

// a_i of Σ a_i p^i from those of Σ b_j (p/scale)^j.
void unscale(std::vector<double>& coefficients, double scale) {
  double power = 1;
  for (double& c : coefficients) {
    c /= power;
    power *= scale;
  }
}

} // namespace

hal::Result<LampCalibration> find_lamp_lines(std::span<const double> spectrum,
                                             std::span<const double> lines_nm,
                                             std::string_view name) {
  HAL_CHECK(check_lines(lines_nm));
  const auto refuse = [&](std::string_view words) {
    return hal::fail(ErrorCode::bad_data, "{}: {}", name, words);
  };
  if (spectrum.empty())
    return refuse("it has no samples, expected a spectrum of the lamp");
  for (std::size_t p = 0; p < spectrum.size(); ++p) {
    if (!std::isfinite(spectrum[p]))
      return refuse(fmt::format("sample {} is {}, expected a finite number", p, spectrum[p]));
  }
  std::vector<double> level(spectrum.begin(), spectrum.end());
  const double floor = median(level);
  std::vector<double> deviation(level.size());
  for (std::size_t p = 0; p < level.size(); ++p) {
    level[p] -= floor;
    deviation[p] = std::abs(level[p]);
  }
  const double highest = *std::ranges::max_element(level);
  std::vector<Peak> peaks = find_peaks(level, std::max(9 * median(deviation), 0.005 * highest));
  const std::size_t lines = lines_nm.size();
  if (highest <= 0 || peaks.size() < lines)
    return refuse(fmt::format("{} peaks stand out of the noise, expected one for each of the {} "
                              "lines",
                              highest <= 0 ? 0 : peaks.size(), lines));
  if (peaks.size() > lines && peaks[lines].height > 0.6 * peaks[lines - 1].height)
    return refuse(fmt::format("which peaks are the {} lines is not clear: the next one, at pixel "
                              "{:.1f}, is nearly as high ({:.4g}) as the last of them, at pixel "
                              "{:.1f} ({:.4g}); name all lines that are seen",
                              lines, peaks[lines].pixel, peaks[lines].height,
                              peaks[lines - 1].pixel, peaks[lines - 1].height));
  peaks.resize(lines);
  std::ranges::sort(peaks, [](auto a, auto b) { return a.pixel < b.pixel; });

  LampCalibration lamp;
  const auto scale = static_cast<double>(spectrum.size() - 1);
  std::vector<double> unit;
  for (const Peak& peak : peaks) {
    lamp.pixels.push_back(peak.pixel);
    unit.push_back(peak.pixel / scale);
  }
  lamp.polynomial_nm = fit_polynomial(unit, lines_nm, std::clamp<std::size_t>(lines - 2, 1, 3));
  unscale(lamp.polynomial_nm, scale);
  double squares = 0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < lines; ++i) {
    double fitted = 0;
    for (std::size_t c = lamp.polynomial_nm.size(); c-- > 0;)
      fitted = fitted * lamp.pixels[i] + lamp.polynomial_nm[c];
    lamp.residuals_nm.push_back(lines_nm[i] - fitted);
    squares += lamp.residuals_nm[i] * lamp.residuals_nm[i];
    if (std::abs(lamp.residuals_nm[i]) > std::abs(lamp.residuals_nm[worst]))
      worst = i;
  }
  lamp.rms_nm = std::sqrt(squares / static_cast<double>(lines));
  const double pixel_nm =
      std::abs(lines_nm.back() - lines_nm.front()) / (lamp.pixels.back() - lamp.pixels.front());
  constexpr double most_residual_pixels = 1;
  if (std::abs(lamp.residuals_nm[worst]) > most_residual_pixels * pixel_nm)
    return refuse(fmt::format("the lines do not fit the peaks: line {} ({} nm, pixel {:.2f}) is "
                              "off by {:.4f} nm, expected at most {:.4f} nm (a pixel)",
                              worst, lines_nm[worst], lamp.pixels[worst], lamp.residuals_nm[worst],
                              most_residual_pixels * pixel_nm));
  const auto positions =
      positions_from_wavelength(lamp.polynomial_nm, static_cast<int>(spectrum.size()));
  if (!positions)
    return refuse(positions.error().message);
  return lamp;
}

} // namespace octascope::pipeline
