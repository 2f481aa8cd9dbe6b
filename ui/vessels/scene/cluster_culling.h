// Which clusters can be in the picture.
#pragma once

#include <cstdint>
#include <vector>

#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// A cluster to be drawn: this many of its first segments.
struct ClusterPart {
  std::uint32_t cluster;
  std::uint32_t segments;
  // Upper bound of radii on the screen of what is in front of the near plane.
  float largest_radius_px;
};

// What is drawn: only what may be seen or, for comparison, everything. Both make the same picture.
enum class ClusterChoice : std::uint8_t { visible, all };

// Appends to `parts`, in the order of the tree, the clusters that may touch the picture: their
// boxes, widened by their thickest vessel, against the sides of the picture and the near and far
// plane. Returns the number of segments of the others, which are culled. Allocates if `parts` must
// grow.
std::uint64_t choose_clusters(const VesselFrame& frame, const pipeline::VesselClusters& tree,
                              ClusterChoice choice, std::vector<ClusterPart>& parts);

} // namespace octascope::ui
