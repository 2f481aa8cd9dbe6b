#include "firmware-host/commands/bench/flow/flow_tally.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace octascope::firmware_host {

namespace {

constexpr float called_flowing = 0.5F;

std::size_t radius_bin(float radius_um) {
  std::size_t bin = 0;
  while (bin + 1 < radius_bins && radius_um >= static_cast<float>(radius_edges_um[bin + 1]))
    ++bin;
  return bin;
}

double share_of(double part, double whole) {
  return whole > 0 ? part / whole : 0;
}

// The chance that a flowing voxel has more flow than a still one; equal ones count half (the statistic
// of Mann and Whitney). Both sorted.
double area_under_curve(std::span<const float> still, std::span<const float> flowing) {
  double below = 0;
  auto less = still.begin();
  auto not_greater = still.begin();
  for (const float value : flowing) {
    while (less != still.end() && *less < value)
      ++less;
    while (not_greater != still.end() && *not_greater <= value)
      ++not_greater;
    below += 0.5 * static_cast<double>((less - still.begin()) + (not_greater - still.begin()));
  }
  return share_of(below, static_cast<double>(still.size()) * static_cast<double>(flowing.size()));
}

} // namespace

void FlowTally::add_voxels(std::span<const VoxelKind> kinds, std::span<const float> radii_um,
                           std::span<const float> flow) {
  for (std::size_t i = 0; i < flow.size(); ++i) {
    const VoxelKind kind = kinds[i];
    if (kind == VoxelKind::left_out)
      continue;
    ++voxels_;
    if (!std::isnan(flow[i]))
      (kind == VoxelKind::flowing ? flowing_ : still_).push_back(flow[i]);
    if (kind != VoxelKind::flowing)
      continue;
    const std::size_t bin = radius_bin(radii_um[i]);
    ++by_radius_[bin];
    if (flow[i] >= called_flowing)
      ++detected_[bin];
  }
}

void FlowTally::add(const FlowTally& other) {
  still_.insert(still_.end(), other.still_.begin(), other.still_.end());
  flowing_.insert(flowing_.end(), other.flowing_.begin(), other.flowing_.end());
  voxels_ += other.voxels_;
  std::ranges::transform(by_radius_, other.by_radius_, by_radius_.begin(), std::plus<>{});
  std::ranges::transform(detected_, other.detected_, detected_.begin(), std::plus<>{});
}

FlowFigures FlowTally::figures() && {
  std::ranges::sort(still_);
  std::ranges::sort(flowing_);
  const auto called = still_.end() - std::ranges::lower_bound(still_, called_flowing);
  const auto sum = [](const auto& counts) {
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
  };
  FlowFigures figures{.voxels = voxels_,
                      .auc = area_under_curve(still_, flowing_),
                      .told_share = share_of(static_cast<double>(still_.size() + flowing_.size()),
                                             static_cast<double>(voxels_)),
                      .false_positive_share =
                          share_of(static_cast<double>(called), static_cast<double>(still_.size())),
                      .detected_share = share_of(sum(detected_), sum(by_radius_)),
                      .flowing_by_radius = by_radius_};
  for (std::size_t bin = 0; bin < radius_bins; ++bin)
    figures.detected_by_radius[bin] =
        share_of(static_cast<double>(detected_[bin]), static_cast<double>(by_radius_[bin]));
  return figures;
}

} // namespace octascope::firmware_host
