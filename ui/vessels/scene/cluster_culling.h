// Which clusters can be in the picture.
#pragma once

#include <cstdint>
#include <vector>

#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// A cluster that is to be drawn: the first so many of its segments.
struct ClusterPart {
  std::uint32_t cluster;
  std::uint32_t segments;
  // Nothing of the cluster that is in front of the near plane has a larger radius on the screen.
  float largest_radius_px;
};

// How much is drawn: what may be seen, or everything, to measure against. Both make the same
// picture.
enum class ClusterChoice : std::uint8_t { visible, all };

// Adds to `parts`, in the order of the tree, the clusters of which a pixel may be in the picture:
// their boxes, as wide as their thickest vessel more, against the sides of the picture and the near
// and far plane. Returns how many segments the others have: they are culled. Allocates where
// `parts` must grow.
std::uint64_t choose_clusters(const VesselFrame& frame, const pipeline::VesselClusters& tree,
                              ClusterChoice choice, std::vector<ClusterPart>& parts);

} // namespace octascope::ui
