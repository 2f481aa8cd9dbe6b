#include "pipeline/calibration_finder/depth_power.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "pipeline/calibration_finder/fringe.h"
#include "pipeline/calibration_finder/line_transform.h"

namespace octascope::pipeline {

DepthPower::DepthPower(std::size_t samples) : samples_(samples), power_(samples / 2) {}

void DepthPower::add_b_scan(std::span<const double> counts) {
  const std::size_t lines = counts.size() / samples_;
  std::vector<double> mean(samples_);
  for (std::size_t i = 0; i < lines * samples_; ++i)
    mean[i % samples_] += counts[i];
  for (double& value : mean)
    value /= static_cast<double>(lines);
  LineTransform transform{samples_, LineTransform::Direction::forward};
  const auto values = transform.values();
  for (std::size_t line = 0; line < lines; ++line) {
    for (std::size_t p = 0; p < samples_; ++p) {
      const double turn = (static_cast<double>(p) + 0.5) / static_cast<double>(samples_);
      const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * turn);
      values[p] = (counts[line * samples_ + p] - mean[p]) * window;
    }
    transform.run();
    for (std::size_t bin = 0; bin < power_.size(); ++bin)
      power_[bin] += std::norm(values[bin]);
  }
}

DepthPower::Highest DepthPower::highest() const {
  const auto first = power_.begin() + 2 * lowest_fringe_bin;
  const auto peak = std::max_element(first, power_.end());
  std::vector<double> sorted;
  sorted.assign(first, power_.end());
  const auto tenth = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 10);
  std::ranges::nth_element(sorted, tenth);
  if (!(*tenth > 0))
    return {};
  return {10 * std::log10(*peak / *tenth), static_cast<std::size_t>(peak - power_.begin())};
}

} // namespace octascope::pipeline
