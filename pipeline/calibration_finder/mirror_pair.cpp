#include "pipeline/calibration_finder/mirror_pair.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/calibration/k_linearisation.h"

namespace octascope::pipeline {

namespace {

using hal::ErrorCode;
constexpr double two_pi = 2 * std::numbers::pi;
// Between the mirrors, over the line: with fewer, noise of the phase bends k too much.
constexpr double fewest_fringes_apart = 8;

// Linear in k over the pixel, rising.
class WavenumberPhase {
public:
  WavenumberPhase(const std::array<Fringe, 2>& fringes, SampleSide side) : fringes_(fringes) {
    const auto last = static_cast<double>(fringes[0].amplitude.size() - 1);
    const auto span = [&](const Fringe& f) { return f.phase_rad.at(last) - f.phase_rad.at(0); };
    if (side == SampleSide::first_mirror || side == SampleSide::second_mirror)
      weights_ = {1, 1};
    else if (span(fringes[1]) > span(fringes[0]))
      weights_ = {-1, 1};
    else
      weights_ = {1, -1};
  }
  double at(double pixel) const {
    return weights_[0] * fringes_[0].phase_rad.at(pixel) +
           weights_[1] * fringes_[1].phase_rad.at(pixel);
  }

private:
  const std::array<Fringe, 2>& fringes_;
  std::array<double, 2> weights_{};
};

hal::Result<std::vector<double>> invert(const WavenumberPhase& k, std::size_t samples) {
  const auto last = static_cast<double>(samples - 1);
  for (std::size_t p = 1; p < samples; ++p) {
    const auto x = static_cast<double>(p);
    if (k.at(x) <= k.at(x - 1))
      return hal::fail(
          ErrorCode::bad_data,
          "wavenumber is not monotone: the mirrors' phases give {:.4f} rad at pixel {} and {:.4f} "
          "rad at pixel {}, expected it to rise; measure with more light, or farther apart",
          k.at(x - 1), p - 1, k.at(x), p);
  }
  const double from = k.at(0);
  const double span = k.at(last) - from;
  std::vector<double> positions(samples);
  for (std::size_t m = 0; m < samples; ++m) {
    const double target = from + span * static_cast<double>(m) / last;
    double low = 0;
    double high = last;
    for (int step = 0; step < 50; ++step) {
      const double middle = (low + high) / 2;
      (k.at(middle) < target ? low : high) = middle;
    }
    positions[m] = (low + high) / 2;
  }
  return positions;
}

struct Line {
  double offset = 0;
  double slope = 0;
};

Line fit_line(const std::vector<double>& values, const std::vector<double>& weights) {
  double w = 0;
  double x = 0;
  double y = 0;
  for (std::size_t m = 0; m < values.size(); ++m) {
    w += weights[m];
    x += weights[m] * static_cast<double>(m);
    y += weights[m] * values[m];
  }
  x /= w;
  y /= w;
  double xx = 0;
  double xy = 0;
  for (std::size_t m = 0; m < values.size(); ++m) {
    const double u = static_cast<double>(m) - x;
    xx += weights[m] * u * u;
    xy += weights[m] * u * (values[m] - y);
  }
  return {y - x * xy / xx, xy / xx};
}

} // namespace

hal::Result<MirrorPair> combine_fringes(const std::array<Fringe, 2>& fringes, SampleSide side) {
  const std::size_t samples = fringes[0].amplitude.size();
  const WavenumberPhase k{fringes, side};
  const double apart = std::abs(k.at(static_cast<double>(samples - 1)) - k.at(0)) / two_pi;
  if (apart < fewest_fringes_apart)
    return hal::fail(ErrorCode::bad_data,
                     "the mirrors are too close to each other: {:.2f} fringes over the line apart, "
                     "expected at least {}; move the mirror farther",
                     apart, fewest_fringes_apart);
  HAL_TRY(auto positions, invert(k, samples));

  MirrorPair pair{fringes, {}, {1, 1}, std::move(positions), {}};
  if (side == SampleSide::first_mirror || side == SampleSide::no_mirror)
    pair.theta_sign[1] = -1;
  if (side == SampleSide::second_mirror || side == SampleSide::no_mirror)
    pair.theta_sign[0] = -1;
  const double first =
      static_cast<double>(std::max(fringes[0].first_bright, fringes[1].first_bright));
  const double last = static_cast<double>(std::min(fringes[0].last_bright, fringes[1].last_bright));
  std::vector<double> weights(samples);
  std::transform(pair.positions.begin(), pair.positions.end(), weights.begin(),
                 [&](double r) { return r >= first && r <= last ? 1.0 : 0.0; });
  pair.dispersion_rad.assign(samples, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<double> phase(samples);
    std::transform(pair.positions.begin(), pair.positions.end(), phase.begin(),
                   [&](double r) { return fringes[i].phase_rad.at(r); });
    const Line line = fit_line(phase, weights);
    pair.depth_bins[i] = line.slope * static_cast<double>(samples) / two_pi;
    // k is made of both phases, so that both leave the same θ: each gives half of it.
    for (std::size_t m = 0; m < samples; ++m)
      pair.dispersion_rad[m] -=
          pair.theta_sign[i] / 2 * (phase[m] - line.offset - line.slope * static_cast<double>(m));
  }
  if (const auto fault = find_position_fault(pair.positions))
    return hal::fail(ErrorCode::bad_data, *fault);
  if (const auto jump = find_position_jump(pair.positions))
    return hal::fail(ErrorCode::bad_data, *jump);
  return pair;
}

hal::Result<MirrorPair> find_mirror_pair(std::span<const double> first,
                                         std::span<const double> second, SampleSide side) {
  if (first.size() != second.size())
    return hal::fail(ErrorCode::bad_data,
                     "the first mirror has {} samples, the second {}, expected equal lines",
                     first.size(), second.size());
  HAL_TRY(auto one, find_fringe(first, "first mirror"));
  HAL_TRY(auto two, find_fringe(second, "second mirror"));
  return combine_fringes({std::move(one), std::move(two)}, side);
}

} // namespace octascope::pipeline
