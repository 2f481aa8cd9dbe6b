// A flow volume made ready for tracing: voxels of more equal sides, short gaps filled, smoothed.
//
// Voxels of OCT are long: 3.5 µm in depth, 10 µm from A-scan to A-scan, 37.5 µm from B-scan to
// B-scan. As many are averaged along each axis as fit into the middle one of the three spacings:
// three depth bins here, which takes noise away and leaves a third of the work.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/volume/volume_geometry.h"

namespace octascope::pipeline {

inline constexpr float unknown_flow = -1;

// Axes x, y, z as in the volume's frame (registration.h): A-scans, B-scans, depth. Values in the
// order [y][x][z].
struct FlowGrid {
  std::array<int, 3> counts{};
  std::array<double, 3> spacing_um{};
  std::vector<float> flow;   // mean over the voxel; unknown_flow where more than half was not told
  std::vector<float> smooth; // over the next voxels in x and z (¼, ½, ¼), of those that are known
  int told_b_scans = 0;      // of the volume, in rows of y with known flow
  int moved_b_scans = 0;     // of them, taken for moved as a whole: unknown

  std::size_t at(int x, int y, int z) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(counts[0]) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(counts[2]) +
           static_cast<std::size_t>(z);
  }
  double widest_um() const;
  double narrowest_um() const;
  double voxel_um3() const { return spacing_um[0] * spacing_um[1] * spacing_um[2]; }
};

// A B-scan of which more than this flows on the average has moved.
inline constexpr double most_flow_of_a_b_scan = 0.5;

// `flow`: geometry.voxels() values [b][a][z], NaN where unknown. Up to two B-scans in a row that are
// unknown at a place are interpolated between their neighbours. ErrorCode::invalid_argument: counts or
// spacings that are not positive, or another number of values; unsupported: more cells than 32 bits
// number; bad_data: values that are no flow.
// `grid` is replaced; of one of the same shape its memory is taken.
hal::Result<> make_flow_grid(const VolumeGeometry& geometry, std::span<const float> flow,
                             FlowGrid& grid);
// Of a live volume's counts (flow_scale.h), which are always flow.
hal::Result<> make_flow_grid(const VolumeGeometry& geometry, std::span<const std::uint8_t> counts,
                             FlowGrid& grid);

} // namespace octascope::pipeline
