// Selects the clusters that may be visible.
#pragma once

#include <cstdint>
#include <vector>

#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// A cluster to be drawn: only the first `segments` of it.
struct ClusterPart {
  std::uint32_t cluster;
  std::uint32_t segments;
  // Upper bound of the radius on the screen of what lies beyond the near plane.
  float largest_radius_px;
};

// Draws what may be visible, or everything (for comparison). Both give the same picture.
enum class ClusterChoice : std::uint8_t { visible, all };

// Appends to `parts`, in tree order, the clusters that may cover a pixel: tests their boxes,
// enlarged by their thickest vessel, against the sides of the picture and the near and far plane.
// Returns the number of segments in the other clusters, which are culled. Allocates only to grow
// `parts`.
std::uint64_t choose_clusters(const VesselFrame& frame, const pipeline::VesselClusters& tree,
                              ClusterChoice choice, std::vector<ClusterPart>& parts);

} // namespace octascope::ui
