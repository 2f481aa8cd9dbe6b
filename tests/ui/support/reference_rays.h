// Ray casting as one would write it down, in double precision: every sample of every ray, no lanes,
// no leaps, no early end. The ray caster's pictures are compared with these.
#pragma once

#include <vector>

#include "pipeline/volume/volume.h"
#include "ui/ray_caster/ray_caster.h"
#include "ui/view/camera.h"
#include "ui/view/view_state.h"

namespace octascope::tests {

struct ReferencePixel {
  double grey = 0; // premultiplied, 0…255; with flow, red
  double opacity = 0;
  double depth_mm = 0; // infinity where less than half is hidden
  double green = 0;
  double blue = 0;
};

// Rows from the top.
std::vector<ReferencePixel> reference_rays(const pipeline::Volume& volume, const ui::Camera& camera,
                                           const ui::ViewState& window,
                                           const ui::RaySettings& settings, int width, int height);

} // namespace octascope::tests
