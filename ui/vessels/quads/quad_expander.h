// Segments as quads, expanded by the processor.
#pragma once

#include <cstdint>
#include <span>

#include "ui/vessels/quads/quad_programs.h"
#include "ui/vessels/scene/segment_projection.h"

namespace octascope::ui {

// A corner. All corners of a segment are equal; shaders/vessels/vessel_quad_stream.vert moves each to its
// place by its index.
struct QuadVertex {
  SegmentOutline outline;
  std::uint32_t colour; // index in the palette
};
static_assert(sizeof(QuadVertex) == 36);

// Writes quad_vertices vertices to `to` for each segment that may cover a pixel centre, and
// returns the number of such segments. `to` must have room for all segments. `nodes` are the
// tree's. Any thread.
std::uint32_t expand_quads(const VesselFrame& frame, const PlacedCluster& cluster,
                           std::span<const pipeline::PackedNode> nodes, QuadVertex* to);

} // namespace octascope::ui
