// Vessels laid into a volume's picture by the processor.
#pragma once

#include "ui/depth_mask/depth_image.h"
#include "ui/ray_caster/ray_caster.h"

namespace octascope::ui {

// `image` is the volume up to the vessels. Where there is one, its colour goes under what is there;
// and where it is not opaque, that is mixed with `alone`, the volume without vessels, which may be
// null only where `opacity` is 1. What was drawn grows to hold all vessels. All are of one size.
void merge_mask(RayImage& image, const DepthImage& vessels, float opacity, const RayImage* alone);

} // namespace octascope::ui
