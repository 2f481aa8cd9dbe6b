#include "pipeline/scan/scan_lag_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

constexpr int bands = DownsampledSweep::bands;
// Lines on either side that a slope is made of. Fewer leave more of the speckle, which neighbouring
// sweeps do not share; more make peaks so wide that what else is in the picture pulls at them. On
// the twin's phantoms the error is least, and the peak clearest, from 4 to 8.
constexpr int reach = 6;

// Half-width of a peak, in lines: the slope's, and some structure's.
constexpr int peak_half_width = 12;
constexpr int parabola_half_width = 4;

OCTASCOPE_CPU_CLONES
std::int32_t product(const std::int16_t* a, const std::int16_t* b) {
  std::int32_t sum = 0; // 32 · 1530² at the most
  for (int band = 0; band < bands; ++band)
    sum += std::int32_t{a[band]} * b[band];
  return sum;
}

// Least squares over the peak and its neighbours; where the curve is not round, the peak itself.
double parabola_peak(const std::vector<double>& curve, int at) {
  double slope = 0;
  double bend = 0;
  double norm_slope = 0;
  double norm_bend = 0;
  constexpr double mean_square = parabola_half_width * (parabola_half_width + 1) / 3.0;
  for (int i = -parabola_half_width; i <= parabola_half_width; ++i) {
    const double value = curve[static_cast<std::size_t>(at + i)];
    const double square = i * i - mean_square;
    slope += i * value;
    norm_slope += i * i;
    bend += square * value;
    norm_bend += square * square;
  }
  if (bend >= 0)
    return at;
  const double shift = -(slope / norm_slope) / (2 * bend / norm_bend);
  return at + std::clamp<double>(shift, -parabola_half_width, parabola_half_width);
}

} // namespace

bool ScanLagEstimate::convincing() const {
  return pairs > 0 && significance >= 8 && rival <= 0.8 && disagreement_a_scans <= 4;
}

ScanLagEstimator::ScanLagEstimator(const ScanPlan& plan)
    : plan_(plan), lines_(plan.converted_lines()) {
  const int search = std::min(widest_search_a_scans, plan.a_scans / 4);
  first_sum_ =
      plan.a_scans - 1 + static_cast<int>(std::lround(2 * plan.scan_lag_a_scans)) - 2 * search;
  sums_ = 4 * search + 1;
  const auto lines = static_cast<std::size_t>(lines_);
  for (Slopes* slopes : {&forward_, &backward_}) {
    slopes->values.resize(lines * bands);
    slopes->energy.resize(lines + 1);
  }
  for (Group& group : groups_) {
    for (auto* sums : {&group.products, &group.forward_energy, &group.backward_energy})
      sums->resize(static_cast<std::size_t>(sums_));
  }
  curve_.resize(static_cast<std::size_t>(sums_));
}

void ScanLagEstimator::find_slopes(const DownsampledSweep& sketch, int sweep,
                                   Slopes& slopes) const {
  slopes.energy[0] = 0;
  for (int line = 0; line < lines_; ++line) {
    std::int16_t* slope = slopes.values.data() + static_cast<std::size_t>(line) * bands;
    if (line < reach || line >= lines_ - reach) {
      std::fill_n(slope, bands, std::int16_t{0});
    } else {
      for (std::size_t band = 0; band < bands; ++band) {
        int sum = 0;
        for (int away = 1; away <= reach; ++away)
          sum += sketch.line(sweep, line + away)[band] - sketch.line(sweep, line - away)[band];
        slope[band] = static_cast<std::int16_t>(sum);
      }
    }
    slopes.energy[static_cast<std::size_t>(line) + 1] =
        slopes.energy[static_cast<std::size_t>(line)] + product(slope, slope);
  }
}

void ScanLagEstimator::add_pair(Group& group) const {
  for (int i = 0; i < sums_; ++i) {
    const int sum = first_sum_ + i;
    const int first = std::max(0, sum - (lines_ - 1));
    const int last = std::min(lines_ - 1, sum);
    if (last < first)
      continue;
    double products = 0;
    for (int line = first; line <= last; ++line)
      products += product(forward_.values.data() + static_cast<std::size_t>(line) * bands,
                          backward_.values.data() + static_cast<std::size_t>(sum - line) * bands);
    const auto at = static_cast<std::size_t>(i);
    const auto energy = [](const Slopes& slopes, int from, int to) {
      return slopes.energy[static_cast<std::size_t>(to) + 1] -
             slopes.energy[static_cast<std::size_t>(from)];
    };
    group.products[at] -= products; // read backwards, a slope changes its sign
    group.forward_energy[at] += energy(forward_, first, last);
    group.backward_energy[at] += energy(backward_, sum - last, sum - first);
  }
  ++group.pairs;
}

// −1: these two are no pair.
int ScanLagEstimator::group_of(int forward, int backward) const {
  if (backward < 0 || backward >= plan_.sweeps())
    return -1;
  if (plan_.repeats == 1)
    return backward > forward ? 0 : 1;
  if (plan_.b_scan_of(backward) != plan_.b_scan_of(forward))
    return -1;
  return groups_[0].pairs > groups_[1].pairs ? 1 : 0;
}

void ScanLagEstimator::add_pairs(const DownsampledSweep& sketch) {
  for (Group& group : groups_) {
    for (auto* sums : {&group.products, &group.forward_energy, &group.backward_energy})
      std::ranges::fill(*sums, 0.0);
    group.pairs = 0;
  }
  const int forward_sweeps = (plan_.sweeps() + 1) / 2;
  const int step = std::max(1, (forward_sweeps + most_pairs - 1) / most_pairs);
  for (int forward = 0; forward < plan_.sweeps(); forward += 2 * step) {
    if (!sketch.came(forward))
      continue;
    find_slopes(sketch, forward, forward_);
    for (const int backward : {forward - 1, forward + 1}) {
      const int group = group_of(forward, backward);
      if (group < 0 || !sketch.came(backward))
        continue;
      find_slopes(sketch, backward, backward_);
      add_pair(groups_[static_cast<std::size_t>(group)]);
    }
  }
}

ScanLagEstimator::Peak ScanLagEstimator::find_peak(const Group& group) {
  for (std::size_t i = 0; i < curve_.size(); ++i) {
    const double energy = std::sqrt(group.forward_energy[i] * group.backward_energy[i]);
    curve_[i] = energy > 0 ? group.products[i] / energy : 0;
  }
  const int at = static_cast<int>(std::ranges::max_element(curve_) - curve_.begin());
  if (at < parabola_half_width || at >= sums_ - parabola_half_width)
    return {}; // the true one lies beyond the search
  const double peak = curve_[static_cast<std::size_t>(at)];
  double rival = 0;
  for (int i = 0; i < sums_; ++i) {
    if (std::abs(i - at) > peak_half_width)
      rival = std::max(rival, curve_[static_cast<std::size_t>(i)]);
  }
  if (peak <= 0)
    return {};
  // Independent values in the sums: slopes that overlap are not.
  const int sum = first_sum_ + at;
  const int overlap = std::min(lines_ - 1, sum) - std::max(0, sum - (lines_ - 1)) + 1;
  const double independent = static_cast<double>(group.pairs) *
                             std::min(bands, plan_.geometry().depths) * overlap / (2 * reach);
  return {.sum = first_sum_ + parabola_peak(curve_, at),
          .correlation = peak,
          .significance = peak * std::sqrt(independent),
          .rival = rival / peak};
}

ScanLagEstimate ScanLagEstimator::estimate(const DownsampledSweep& sketch) {
  add_pairs(sketch);
  const Peak first = find_peak(groups_[0]);
  const Peak second = find_peak(groups_[1]);
  const int pairs = std::min(groups_[0].pairs, groups_[1].pairs);
  return {.scan_lag_a_scans = ((first.sum + second.sum) / 2 - (plan_.a_scans - 1)) / 2,
          .correlation = std::min(first.correlation, second.correlation),
          .significance = std::min(first.significance, second.significance),
          .rival = std::max(first.rival, second.rival),
          .disagreement_a_scans = std::abs(first.sum - second.sum),
          .pairs = pairs};
}

} // namespace octascope::pipeline
