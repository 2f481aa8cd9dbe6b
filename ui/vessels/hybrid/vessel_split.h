// Which segments GL draws and which the processor.
#pragma once

#include <cstdint>
#include <vector>

#include "ui/vessels/scene/vessel_scene.h"

namespace octascope::ui {

// By cluster: so many of its first nodes, references included, make the segments that GL draws.
// Whole orders of a cluster, so that both sides agree to the last segment.
using VesselSplit = std::vector<std::uint8_t>;

// GL gets those orders of each cluster whose radius is at least `gl_radius_px` where the cluster is
// nearest: GL is good at many pixels, the processor at many segments. Infinity: GL gets none.
// Allocates where `split` must grow.
void split_by_radius(const VesselScene& scene, float gl_radius_px, VesselSplit& split);

} // namespace octascope::ui
