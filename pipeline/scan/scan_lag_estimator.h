// Estimates the mirror lag of a bidirectional scan from the image alone.
//
// Line l of a forward sweep and line l' of the backward sweep beside it show the same place where
// l + l' = A − 1 + 2p (sweep_alignment.h): the mirror symmetry of neighbouring sweeps. So one is
// correlated with the other reversed, over a range of sums c = l + l', and the peak of the
// normalised correlation gives p = (c − A + 1)/2, refined below whole lines by a parabola.
//
// What is correlated is the slope along the fast axis: what does not change from line to line
// (fixed artefacts, a level that falls with depth) has none. The products and energies of many
// pairs, spread over the volume, are added up before they are divided.
//
// Tissue that slants across the scan shifts the sweep after and the sweep before in opposite
// directions. So the pairs with the sweep after and those with the sweep before give a peak each,
// and their mean is the answer. With several sweeps of each B-scan the pairs are taken within
// B-scans, where nothing slants, and go to the two groups by turns.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/scan/downsampled_sweep.h"
#include "pipeline/scan/scan_plan.h"

namespace octascope::pipeline {

struct ScanLagEstimate {
  double scan_lag_a_scans = 0; // p
  // Of the weaker group: the correlation peak, −1 … 1; the same in standard deviations of pure
  // noise; and the next best peak elsewhere, as a fraction of it. The disagreement is the distance
  // between the peaks of the two groups, in A-scans between neighbours.
  double correlation = 0;
  double significance = 0;
  double rival = 1;
  double disagreement_a_scans = 0;
  int pairs = 0;

  // Whether the image shows a localised structure. The limits reject noise with a margin:
  // tests/pipeline/scan/scan_lag_estimator_test.cpp.
  bool convincing() const;
};

// One thread at a time. Its buffers are made once; estimate() allocates nothing.
class ScanLagEstimator {
public:
  // Searches ± this around the plan's scan_lag_a_scans, or a quarter of a sweep if that is
  // less.
  static constexpr int widest_search_a_scans = 32;
  static constexpr int most_pairs = 64; // of each group

  explicit ScanLagEstimator(const ScanPlan& plan);

  ScanLagEstimate estimate(const DownsampledSweep& sketch);

private:
  // Slopes of one sweep [line][band], and the running sum of their energies by line.
  struct Slopes {
    std::vector<std::int16_t> values;
    std::vector<double> energy; // of lines 0 … l − 1
  };
  // Sums over the pairs of one group, by c.
  struct Group {
    std::vector<double> products, forward_energy, backward_energy;
    int pairs = 0;
  };
  struct Peak {
    double sum = 0; // c
    double correlation = 0;
    double significance = 0;
    double rival = 1;
  };

  void find_slopes(const DownsampledSweep& sketch, int sweep, Slopes& slopes) const;
  void add_pair(Group& group) const;
  void add_pairs(const DownsampledSweep& sketch);
  int group_of(int forward, int backward) const;
  Peak find_peak(const Group& group);

  ScanPlan plan_;
  int lines_;
  int first_sum_; // the lowest c tried
  int sums_;      // how many are tried
  Slopes forward_;
  Slopes backward_;
  std::array<Group, 2> groups_;
  std::vector<double> curve_;
};

} // namespace octascope::pipeline
