#include "pipeline/calibration/k_linearisation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace octascope::pipeline {

namespace {

double polynomial(std::span<const double> coefficients, double x) {
  double sum = 0;
  for (std::size_t i = coefficients.size(); i-- > 0;)
    sum = sum * x + coefficients[i];
  return sum;
}

// Modified Bessel function of the first kind, order 0, by its power series.
double bessel_i0(double x) {
  double term = 1;
  double sum = 1;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    const double factor = x / (2.0 * k);
    term *= factor * factor;
    sum += term;
  }
  return sum;
}

double windowed_sinc(double distance) {
  // Beta 4 keeps the loss at 3/4 of the depth range at 0.6 dB with artefacts of −34 dB; a wider
  // main lobe (beta 6, Hann) loses 1 dB there, a narrower one has artefacts at half the range.
  constexpr double beta = 4;
  constexpr double half_width = 4;
  const double u = distance / half_width;
  if (std::abs(u) >= 1)
    return 0;
  const double x = std::numbers::pi * distance;
  const double sinc = std::abs(x) < 1e-9 ? 1.0 : std::sin(x) / x;
  return sinc * bessel_i0(beta * std::sqrt(1 - u * u)) / bessel_i0(beta);
}

struct Taps {
  int width;
  int before; // taps in front of the pixel at or left of the position
  std::array<double, 8> weights;
};

// Weights for a position `f` (0 ≤ f < 1) behind a pixel; each set sums to 1.
Taps taps_at(Interpolation interpolation, double f) {
  switch (interpolation) {
  case Interpolation::linear: return {2, 0, {1 - f, f}};
  case Interpolation::cubic:
    return {4,
            1,
            {((-0.5 * f + 1) * f - 0.5) * f, (1.5 * f - 2.5) * f * f + 1,
             ((-1.5 * f + 2) * f + 0.5) * f, (0.5 * f - 0.5) * f * f}};
  case Interpolation::sinc8: break;
  }
  Taps taps{8, 3, {}};
  double sum = 0;
  for (int t = 0; t < 8; ++t)
    sum += taps.weights[static_cast<std::size_t>(t)] = windowed_sinc(t - 3 - f);
  for (double& weight : taps.weights)
    weight /= sum;
  return taps;
}

} // namespace

std::vector<double> evaluate_unit_polynomial(std::span<const double> coefficients, int samples) {
  std::vector<double> values(static_cast<std::size_t>(samples));
  for (std::size_t m = 0; m < values.size(); ++m)
    values[m] = polynomial(coefficients, static_cast<double>(m) / (samples - 1));
  return values;
}

hal::Result<std::vector<double>> positions_from_wavelength(std::span<const double> coefficients_nm,
                                                           int samples) {
  const auto wavelength = [&](double p) { return polynomial(coefficients_nm, p); };
  const bool rising = wavelength(samples - 1) > wavelength(0);
  for (int p = 0; p < samples; ++p) {
    const double here = wavelength(p);
    if (!std::isfinite(here) || here <= 0)
      return hal::fail(hal::ErrorCode::bad_data,
                       "wavelength at pixel {} is {} nm, expected more than 0", p, here);
    const double before = p == 0 ? 0 : wavelength(p - 1);
    if (p > 0 && (rising ? here <= before : here >= before))
      return hal::fail(hal::ErrorCode::bad_data,
                       "wavelength is not monotone: {} nm at pixel {}, {} nm at pixel {}", before,
                       p - 1, here, p);
  }

  const double k_first = 1 / wavelength(0); // the factor 2π drops out
  const double k_last = 1 / wavelength(samples - 1);
  std::vector<double> positions(static_cast<std::size_t>(samples));
  for (std::size_t m = 0; m < positions.size(); ++m) {
    const double u = static_cast<double>(m) / (samples - 1);
    const double target_nm = 1 / (k_first + (k_last - k_first) * u);
    double low = 0;
    double high = samples - 1;
    for (int step = 0; step < 60; ++step) {
      const double middle = (low + high) / 2;
      ((wavelength(middle) < target_nm) == rising ? low : high) = middle;
    }
    positions[m] = (low + high) / 2;
  }
  return positions;
}

std::vector<double> invert_curve(std::span<const double> curve) {
  const std::size_t last = curve.size() - 1;
  const bool rising = curve[last] > curve[0];
  std::vector<double> positions(curve.size());
  std::size_t p = 0;
  for (std::size_t m = 0; m <= last; ++m) {
    const double target =
        curve[0] + (curve[last] - curve[0]) * (static_cast<double>(m) / static_cast<double>(last));
    while (p + 1 < last && (rising ? curve[p + 1] <= target : curve[p + 1] >= target))
      ++p;
    positions[m] =
        std::clamp(static_cast<double>(p) + (target - curve[p]) / (curve[p + 1] - curve[p]), 0.0,
                   static_cast<double>(last));
  }
  return positions;
}

double distance_the_other_way_round(std::span<const double> positions) {
  std::vector<double> other = invert_curve(positions);
  if (positions.back() < positions.front())
    std::ranges::reverse(other);
  double farthest = 0;
  for (std::size_t m = 0; m < other.size(); ++m)
    farthest = std::max(farthest, std::abs(other[m] - positions[m]));
  return farthest;
}

std::optional<std::string> find_position_fault(std::span<const double> positions) {
  const bool rising = positions.back() > positions.front();
  const auto last_pixel = static_cast<double>(positions.size() - 1);
  std::size_t inside = 0;
  for (std::size_t m = 0; m < positions.size(); ++m) {
    const double here = positions[m];
    if (!std::isfinite(here))
      return fmt::format("position {} is {}, expected a finite pixel position", m, here);
    inside += here >= -1 && here <= last_pixel + 1 ? 1 : 0;
    if (m == 0)
      continue;
    const double before = positions[m - 1];
    if (rising ? here <= before : here >= before)
      return fmt::format("positions are not monotone: position {} is {}, position {} is {}, "
                         "expected them to {} all along",
                         m - 1, before, m, here, rising ? "rise" : "fall");
  }
  if (inside < positions.size() / 2)
    return fmt::format("only {} of {} positions lie on the line, expected most of them within 0 "
                       "to {} (pixels, not nm; a table of wavenumbers needs table_gives = "
                       "\"wavenumber\")",
                       inside, positions.size(), last_pixel);
  return std::nullopt;
}

std::optional<std::string> find_position_jump(std::span<const double> positions) {
  constexpr std::size_t reach = 4; // steps that are looked at on either side
  for (std::size_t m = 0; m + 1 < positions.size(); ++m) {
    std::array<double, 2 * reach> around{};
    std::size_t count = 0;
    const std::size_t first = m >= reach ? m - reach : 0;
    for (std::size_t i = first; i <= m + reach && i + 1 < positions.size(); ++i) {
      if (i != m)
        around[count++] = std::abs(positions[i + 1] - positions[i]);
    }
    const auto median = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(around.begin(), median, around.begin() + static_cast<std::ptrdiff_t>(count));
    const double step = std::abs(positions[m + 1] - positions[m]);
    if (step > 2 * *median + 0.25)
      return fmt::format("positions jump: position {} is {}, position {} is {}, a step of {:.3f} "
                         "where its neighbours' are about {:.3f}",
                         m, positions[m], m + 1, positions[m + 1], step, *median);
  }
  return std::nullopt;
}

ResamplingTaps make_resampling_taps(std::span<const double> positions,
                                    Interpolation interpolation) {
  const auto samples = static_cast<int>(positions.size());
  ResamplingTaps taps;
  bool own_pixel = true;
  for (int m = 0; m < samples; ++m)
    own_pixel = own_pixel && positions[static_cast<std::size_t>(m)] == m;
  if (own_pixel)
    return taps;

  taps.width = interpolation == Interpolation::sinc8 ? 8 : 4;
  const std::size_t padded = (positions.size() + 3) / 4 * 4;
  taps.first.resize(padded);
  taps.weights.resize(padded * static_cast<std::size_t>(taps.width));
  for (std::size_t m = 0; m < positions.size(); ++m) {
    const double floor = std::floor(positions[m]);
    const Taps ideal = taps_at(interpolation, positions[m] - floor);
    const int ideal_first = static_cast<int>(floor) - ideal.before;
    const int first = std::clamp(ideal_first, 0, samples - taps.width);
    taps.first[m] = first;
    for (int t = 0; t < ideal.width; ++t) {
      const int pixel = std::clamp(ideal_first + t, 0, samples - 1);
      taps.weights[m * static_cast<std::size_t>(taps.width) +
                   static_cast<std::size_t>(pixel - first)] +=
          static_cast<float>(ideal.weights[static_cast<std::size_t>(t)]);
    }
  }
  return taps;
}

} // namespace octascope::pipeline
