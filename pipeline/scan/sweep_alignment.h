// Aligns bidirectional sweeps: which lines of each are kept, and in which order.
//
// The mirror lags behind its command by p lines. Line l of a forward sweep then shows the place
// l − p, line l of a backward one A − 1 − l + p. Neighbours agree when the kept lines of forward
// sweeps begin at f and those of backward ones at g with f + g = 2p. Whole lines alone leave up to
// half an A-scan between neighbours: too much. Interpolating by the fraction of p blurs by up to a
// half. So 2p is rounded, its whole part shared out between f and g, and only the rest (up to
// ±1/2) is interpolated, half of it in either: each level is at least 3/4 its own line's, nothing
// remains but the error of p, and both directions are blurred alike, so that no comb appears in
// the texture either. Levels are interpolated, not spectra, whose phases differ from line to line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pipeline/scan/scan_plan.h"

namespace octascope::pipeline {

class SweepAlignment {
public:
  // Of a plan that is bidirectional or not (then lines are merely kept in order).
  SweepAlignment() = default;
  SweepAlignment(const ScanPlan& plan, double scan_lag_a_scans);

  // `lines` [line][z], plan.converted_lines() of them, of one sweep; `a_scans` [a][z] in the order
  // of the tissue. Kept lines outside the sweep repeat its outermost line. Allocates nothing.
  void apply(std::span<const std::uint8_t> lines, bool backwards,
             std::span<std::uint8_t> a_scans) const noexcept;
  // The same of levels in decibels.
  void apply(std::span<const float> lines, bool backwards, std::span<float> a_scans) const noexcept;

  // Where the kept lines of a sweep begin, in lines; usually fractional.
  double first_line(bool backwards) const {
    const Shift& shift = backwards ? backward_ : forward_;
    return shift.line + shift.next_weight / double{one};
  }
  double scan_lag_a_scans() const { return scan_lag_a_scans_; }

  // A-scans at the ends of the sweeps (the worse direction) that repeat the outermost line.
  int repeated_a_scans() const;

private:
  static constexpr int one = 256;

  // A-scan j of the sweep is line `line + j`, and the next with `next_weight` / one.
  struct Shift {
    int line = 0;
    int next_weight = 0;
  };
  static Shift shift_by(double lines);
  template <class Level>
  void place(std::span<const Level> lines, bool backwards, std::span<Level> a_scans) const noexcept;

  std::size_t depths_ = 0;
  int lines_ = 0;
  int a_scans_ = 0;
  Shift forward_;
  Shift backward_;
  double scan_lag_a_scans_ = 0;
};

} // namespace octascope::pipeline
