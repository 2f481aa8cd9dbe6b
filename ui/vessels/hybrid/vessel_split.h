// Splits a vessel tree between GL and the processor.
#pragma once

#include <cstdint>
#include <vector>

#include "ui/vessels/scene/vessel_scene.h"

namespace octascope::ui {

// Per cluster: the number of first nodes, references included, whose segments GL draws. Always
// whole orders of a cluster, so that both sides agree on every segment.
using VesselSplit = std::vector<std::uint8_t>;

// GL gets the orders of each cluster whose radius is at least `gl_radius_px` at the cluster's
// nearest point: GL is fast with many pixels, the processor with many segments. Infinity: GL gets
// none. Allocates only to grow `split`.
void split_by_radius(const VesselScene& scene, float gl_radius_px, VesselSplit& split);

} // namespace octascope::ui
