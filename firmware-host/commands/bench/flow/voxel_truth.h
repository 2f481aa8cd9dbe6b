// What is true of the voxels of a simulated B-scan: tissue or not, flowing or not, in how wide a
// vessel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/packed_bin.h"
#include "sim/phantoms/phantom_column.h"
#include "sim/spectra/repeated_sweeps.h"
#include "sim/spectra/tissue_motion.h"

namespace octascope::firmware_host {

enum class VoxelKind : std::uint8_t {
  left_out, // no tissue, not 3 dB above the noise, or at a vessel's wall
  still,    // no part of it flows; tails below vessels as well
  flowing,  // half of it or more
};

// Of one B-scan, [a][z]. Where tissue is: below the phantom's surface, moved as it was while the first
// repeat was swept, which is where the flow volume has it. Signal: the power of all repeats averaged
// over 15 A-scans and 9 depths, less the noise: the mean power above the surface.
//
// One object a thread; `sweeps` must outlive it.
class VoxelTruth {
public:
  // `motion`: what the sweeps were made with.
  VoxelTruth(const sim::RepeatedSweeps& sweeps, const sim::TissueMotion& motion);

  // `bins` of B-scan b: its repeats, [repeat][a][z].
  void look_at(int b, std::span<const pipeline::PackedBin> bins);

  std::span<const VoxelKind> kinds() const { return kinds_; }
  // In µm, of the vessel that a flowing voxel is in.
  std::span<const float> radii_um() const { return radii_um_; }

private:
  void place_a_scan(int b, int a);
  void average_power(std::span<const pipeline::PackedBin> bins);
  double noise_power() const;

  const sim::RepeatedSweeps& sweeps_;
  sim::TissueMotion motion_;
  std::size_t depths_;
  std::size_t a_scans_;
  sim::Column column_;
  std::vector<VoxelKind> kinds_;
  std::vector<float> radii_um_;
  std::vector<std::size_t> surfaces_; // the first depth of tissue, by A-scan
  std::vector<float> power_;          // mean of the repeats
  std::vector<double> sums_;          // of power_ over A-scans 0 … a and depths 0 … z
};

} // namespace octascope::firmware_host
