#include "pipeline/scan/sweep_alignment.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

OCTASCOPE_CPU_CLONES
void blend(const std::uint8_t* here, const std::uint8_t* next, std::uint16_t next_weight,
           std::size_t count, std::uint8_t* __restrict result) {
  const auto here_weight = static_cast<std::uint16_t>(256 - next_weight);
  for (std::size_t z = 0; z < count; ++z)
    result[z] = static_cast<std::uint8_t>(
        static_cast<std::uint16_t>(here_weight * here[z] + next_weight * next[z] + 128) >> 8);
}

void blend(const float* here, const float* next, std::uint16_t next_weight, std::size_t count,
           float* __restrict result) {
  const float share = static_cast<float>(next_weight) / 256;
  for (std::size_t z = 0; z < count; ++z)
    result[z] = here[z] + share * (next[z] - here[z]);
}

} // namespace

SweepAlignment::SweepAlignment(const ScanPlan& plan, double scan_lag_a_scans)
    : depths_(static_cast<std::size_t>(plan.geometry().depths)), lines_(plan.converted_lines()),
      a_scans_(plan.a_scans), scan_lag_a_scans_(plan.bidirectional ? scan_lag_a_scans : 0) {
  const double both = 2 * scan_lag_a_scans_;
  const double whole = std::round(both);
  const double rest = (both - whole) / 2;
  const double forward = std::floor(whole / 2);
  forward_ = shift_by(forward + rest);
  backward_ = shift_by(whole - forward + rest);
}

SweepAlignment::Shift SweepAlignment::shift_by(double lines) {
  const auto steps = static_cast<int>(std::lround(lines * one));
  const int line = (steps >= 0 ? steps : steps - (one - 1)) / one; // towards −∞
  return {line, steps - line * one};
}

int SweepAlignment::repeated_a_scans() const {
  const auto beyond = [&](const Shift& shift) {
    const int last = shift.line + a_scans_ - 1 + (shift.next_weight > 0 ? 1 : 0);
    return std::max({-shift.line, last - (lines_ - 1), 0});
  };
  return std::min(std::max(beyond(forward_), beyond(backward_)), a_scans_);
}

void SweepAlignment::apply(std::span<const std::uint8_t> lines, bool backwards,
                           std::span<std::uint8_t> a_scans) const noexcept {
  place(lines, backwards, a_scans);
}

void SweepAlignment::apply(std::span<const float> lines, bool backwards,
                           std::span<float> a_scans) const noexcept {
  place(lines, backwards, a_scans);
}

template <class Level>
void SweepAlignment::place(std::span<const Level> lines, bool backwards,
                           std::span<Level> a_scans) const noexcept {
  assert(lines.size() >= static_cast<std::size_t>(lines_) * depths_);
  assert(a_scans.size() >= static_cast<std::size_t>(a_scans_) * depths_);
  const Shift shift = backwards ? backward_ : forward_;
  const auto line_at = [&](int line) {
    return lines.data() + static_cast<std::size_t>(std::clamp(line, 0, lines_ - 1)) * depths_;
  };
  for (int j = 0; j < a_scans_; ++j) {
    const auto a = static_cast<std::size_t>(backwards ? a_scans_ - 1 - j : j);
    Level* result = a_scans.data() + a * depths_;
    const Level* here = line_at(shift.line + j);
    if (shift.next_weight == 0)
      std::copy_n(here, depths_, result);
    else
      blend(here, line_at(shift.line + j + 1), static_cast<std::uint16_t>(shift.next_weight),
            depths_, result);
  }
}

} // namespace octascope::pipeline
