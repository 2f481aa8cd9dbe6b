// Merges vessels into a volume's picture, on the processor.
#pragma once

#include "ui/depth_mask/depth_image.h"
#include "ui/ray_caster/ray_caster.h"

namespace octascope::ui {

// `image` is the volume up to the vessels. The colour of each vessel pixel is composited under it.
// If the vessels are not opaque, the result is mixed there with `alone`, the volume without
// vessels, which may be null only if `opacity` is 1. `image.drawn` grows to contain all vessels.
// All images have the same size.
void merge_mask(RayImage& image, const DepthImage& vessels, float opacity, const RayImage* alone);

} // namespace octascope::ui
