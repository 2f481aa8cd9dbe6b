// Composites vessels into a volume's picture on the processor.
#pragma once

#include "ui/depth_mask/depth_image.h"
#include "ui/ray_caster/ray_caster.h"

namespace octascope::ui {

// `image` is the volume up to the vessels. A vessel's colour is composited under it; if vessels are
// not opaque, the result is mixed with `alone`, the volume without vessels, which may be null only
// if `opacity` is 1. The drawn rectangle grows to hold all vessels. All images have the same size.
void merge_mask(RayImage& image, const DepthImage& vessels, float opacity, const RayImage* alone);

} // namespace octascope::ui
