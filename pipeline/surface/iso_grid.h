// A coarser, smoothed volume from which surfaces can be extracted.
//
// Speckle scatters the level of every voxel of an OCT volume by some 5 dB, so that a surface of
// equal level through the voxels themselves falls to pieces. It is also three to ten times
// finer along depth than along the slow axis. So voxels are averaged until cells are about as long
// along all axes, then smoothed over about the same length along all of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/occupancy.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// Samples in the order [b][a][z], depth fastest, in 1/256 of a level's count. Axes in the order
// depth, fast, slow; sample i lies at first_mm + i · cell_mm from the volume's corner.
struct IsoGrid {
  int depths = 0;
  int a_scans = 0;
  int b_scans = 0;
  std::array<float, 3> cell_mm{};
  std::array<float, 3> first_mm{};
  std::array<float, 3> extents_mm{}; // of the whole volume
  int voxels = 0;                    // averaged to a sample
  std::vector<std::uint16_t> levels;
  std::vector<std::uint8_t> present; // one a slow sample: 0 where a B-scan is missing

  std::size_t slice() const {
    return static_cast<std::size_t>(depths) * static_cast<std::size_t>(a_scans);
  }
  std::span<const std::uint16_t> slice(int b) const {
    return std::span{levels}.subspan(static_cast<std::size_t>(b) * slice(), slice());
  }
};

// Voxels averaged along depth, fast and slow axis to one sample: as many, in powers of two, as make
// cells of at most 0.6 of the longest voxel edge, or of 20 µm; and more where the grid would have
// more than four million samples.
std::array<int, 3> iso_factors(const VolumeGeometry& geometry, int first_depth);

// Averages `volume` from depth bin `first_depth` on: the bins before it hold no tissue. Voxels
// that do not fill a sample at the far ends are dropped. A sample with a missing B-scan is absent.
// About two milliseconds for a live volume. Allocates when the geometry changes.
class IsoGridMaker {
public:
  void make(const Volume& volume, int first_depth, IsoGrid& grid);

private:
  std::vector<std::uint32_t> sums_; // of voxels, bin by bin
};

// Smooths with repeated [1 2 1] / 4 along each axis, as often (at most four times) as gives a
// standard deviation of about 0.7 of the longest cell edge, at least 25 µm. Missing samples neither
// spread nor fill up. Allocates when the size changes.
class IsoSmoother {
public:
  // False if `abandoned` returned true; the grid is then unusable.
  template <typename Abandoned> bool smooth(IsoGrid& grid, const Abandoned& abandoned) {
    const std::array<int, 3> passes = passes_for(grid);
    for (int axis = 0; axis < 3; ++axis)
      for (int pass = 0; pass < passes[static_cast<std::size_t>(axis)]; ++pass) {
        if (abandoned())
          return false;
        smooth_along(axis, grid);
      }
    return true;
  }

private:
  static std::array<int, 3> passes_for(const IsoGrid& grid);
  void smooth_along(int axis, IsoGrid& grid);

  std::vector<std::uint16_t> before_; // a column or two slices, as they were
};

// The lowest and highest level of each brick, as whole counts rounded down.
void update_occupancy(const IsoGrid& grid, Occupancy& occupancy, std::vector<std::uint8_t>& counts);

} // namespace octascope::pipeline
