// A flow volume to a vessel tree: what flows, its centrelines with radii, joined and smoothed.
//
// Steps and their sources: flow_grid.h, flowing_voxels.h (hysteresis), wall_distance.h, voxel_paths.h
// (minimum-cost paths), branch_fit.h (places between voxels), tree_assembly.h.
//
// Takes 12 bytes a voxel of the grid, which has a third of an OCT volume's voxels, and about 50 a
// flowing voxel. Allocates, and takes a good part of a second: not for threads that others wait for.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>

#include "hal/result.h"
#include "pipeline/vessels/tracing/flow_grid.h"
#include "pipeline/vessels/tracing/flowing_voxels.h"
#include "pipeline/vessels/tree.h"
#include "pipeline/volume/volume_geometry.h"

namespace octascope::pipeline {

// Trees below are not shown.
inline constexpr double least_trace_quality = 0.5;
// Nor is any looked for below this: it is noise, in which there are paths everywhere.
inline constexpr double least_trace_contrast = 0.7;

struct TracedVessels {
  VesselTree tree;            // in the volume's frame (registration.h); without nodes if refused
  double quality = 0;         // the product of the three below, each 0 to 1
  double explained_share = 0; // of what flows, that belongs to the tree
  double roundness = 0;       // of its vessels (branch_fit.h)
  double contrast = 0;        // 1 - mean flow beside what flows / mean flow in it
  int moved_b_scans = 0;      // left out: they flow as a whole
  std::string
      refusal; // empty: the tree may be shown; else why not, a sentence without its full stop
};

// Keeps most of its memory from trace to trace: to fetch it anew is half of what one costs.
//
// Threads: one at a time.
class VesselTracer {
public:
  // `flow`: geometry.voxels() values [b][a][z], 0 static to 1 flowing, NaN unknown. Errors as
  // make_flow_grid(); once `stop` is requested it leaves soon, with a result of no use.
  hal::Result<TracedVessels> trace(const VolumeGeometry& geometry, std::span<const float> flow,
                                   const std::stop_token& stop = {});
  // The same of a live volume's counts (flow_scale.h).
  hal::Result<TracedVessels> trace(const VolumeGeometry& geometry,
                                   std::span<const std::uint8_t> counts,
                                   const std::stop_token& stop = {});

private:
  TracedVessels trace_grid(const std::stop_token& stop);

  FlowGrid grid_;
  FlowingVoxels voxels_;
};

} // namespace octascope::pipeline
