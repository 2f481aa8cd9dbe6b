#include "pipeline/vessels/tracing/vessel_tracer.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pipeline/vessels/tracing/branch_fit.h"
#include "pipeline/vessels/tracing/branch_sampling.h"
#include "pipeline/vessels/tracing/flow_grid.h"
#include "pipeline/vessels/tracing/flowing_voxels.h"
#include "pipeline/vessels/tracing/tree_assembly.h"
#include "pipeline/vessels/tracing/voxel_paths.h"
#include "pipeline/vessels/tracing/wall_distance.h"

namespace octascope::pipeline {

namespace {

std::string refusal_of(const TracedVessels& traced, const FlowGrid& grid, std::size_t lines) {
  if (grid.told_b_scans == 0)
    return "no flow is known";
  if (2 * grid.moved_b_scans > grid.told_b_scans)
    return fmt::format("{} of {} B-scans flow as a whole: motion, not vessels", grid.moved_b_scans,
                       grid.told_b_scans);
  if (traced.contrast > 0 && traced.contrast < least_trace_contrast)
    return fmt::format(
        "what flows stands out by {:.0f} % from what does not, expected {:.0f} %: noise",
        traced.contrast * 100, least_trace_contrast * 100);
  if (lines == 0)
    return "no vessel was found";
  if (traced.quality < least_trace_quality)
    return fmt::format(
        "the quality is {:.2f}, expected at least {:.2f}: vessels explain {:.0f} % of "
        "what flows, are {:.0f} % round and stand out by {:.0f} %",
        traced.quality, least_trace_quality, traced.explained_share * 100, traced.roundness * 100,
        traced.contrast * 100);
  return {};
}

} // namespace

TracedVessels VesselTracer::trace_grid(const std::stop_token& stop) {
  voxels_.find(grid_, {}, stop);
  const FlowGrid& grid = grid_;
  const FlowingVoxels& voxels = voxels_;
  TracedVessels traced;
  traced.contrast = 1 - voxels.background_share(grid);
  std::vector<VesselLine> lines;
  if (traced.contrast >= least_trace_contrast) {
    const std::vector<float> wall_um = wall_distances(voxels, grid, stop);
    lines = sample_paths(find_voxel_paths(voxels, grid, wall_um, stop), voxels, grid, wall_um);
    fit_lines(lines, voxels, grid, stop);
    extend_ends(lines, voxels, grid, wall_um);
    drop_short(lines, grid);
    const FlowOfLines found = flow_of_lines(lines, voxels, grid, stop);
    if (voxels.all_flow() > 0) // which lacks holes that were filled
      traced.explained_share = std::min(1.0, found.explained / voxels.all_flow());
    traced.roundness = found.roundness;
  }
  traced.moved_b_scans = grid.moved_b_scans;
  traced.quality = traced.explained_share * traced.roundness * traced.contrast;
  traced.refusal = refusal_of(traced, grid, lines.size());
  if (traced.refusal.empty())
    traced.tree = assemble_tree(lines, grid);
  return traced;
}

hal::Result<TracedVessels> VesselTracer::trace(const VolumeGeometry& geometry,
                                               std::span<const float> flow,
                                               const std::stop_token& stop) {
  HAL_CHECK(make_flow_grid(geometry, flow, grid_));
  return trace_grid(stop);
}

hal::Result<TracedVessels> VesselTracer::trace(const VolumeGeometry& geometry,
                                               std::span<const std::uint8_t> counts,
                                               const std::stop_token& stop) {
  HAL_CHECK(make_flow_grid(geometry, counts, grid_));
  return trace_grid(stop);
}

} // namespace octascope::pipeline
