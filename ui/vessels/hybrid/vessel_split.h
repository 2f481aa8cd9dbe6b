// Which segments GL draws, and which the processor.
#pragma once

#include <cstdint>
#include <vector>

#include "ui/vessels/scene/vessel_scene.h"

namespace octascope::ui {

// Per cluster, the number of its first nodes, references included, whose segments GL draws. Always
// whole orders of a cluster, so that both sides agree to the segment.
using VesselSplit = std::vector<std::uint8_t>;

// GL gets those orders of each cluster whose radius is at least `gl_radius_px` at the cluster's
// nearest point: GL is good at many pixels, the processor at many segments. Infinity: GL gets none.
// Allocates if `split` must grow.
void split_by_radius(const VesselScene& scene, float gl_radius_px, VesselSplit& split);

} // namespace octascope::ui
