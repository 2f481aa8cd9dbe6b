// Counts how well flow agrees with truth.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware-host/commands/bench/flow/voxel_truth.h"

namespace octascope::firmware_host {

// Bins of vessels' radii: from each to the next.
inline constexpr std::array<int, 7> radius_edges_um{0, 7, 10, 15, 20, 30, 45};
inline constexpr std::size_t radius_bins = radius_edges_um.size() - 1;

// Flow of half or more is called flowing; NaN is not told. Shares of nothing are 0.
struct FlowFigures {
  std::uint64_t voxels = 0; // flowing or still
  double auc = 0;           // area under the curve of true against false positives, of what is told
  double told_share = 0;
  double false_positive_share = 0; // of told still voxels that are called flowing
  double detected_share = 0;       // of flowing voxels that are; one that is not told is not
  std::array<std::uint64_t, radius_bins> flowing_by_radius{};
  std::array<double, radius_bins> detected_by_radius{};
};

// Takes 4 bytes a told voxel. Add what several threads counted, in any order.
class FlowTally {
public:
  // A voxel each; radii are read of flowing ones.
  void add_voxels(std::span<const VoxelKind> kinds, std::span<const float> radii_um,
                  std::span<const float> flow);
  void add(const FlowTally& other);

  FlowFigures figures() &&;

private:
  std::vector<float> still_; // flow of what is told
  std::vector<float> flowing_;
  std::uint64_t voxels_ = 0;
  std::array<std::uint64_t, radius_bins> by_radius_{};
  std::array<std::uint64_t, radius_bins> detected_{};
};

} // namespace octascope::firmware_host
