// Merges vessels into a volume's picture, on the processor.
#pragma once

#include "ui/depth_mask/depth_image.h"
#include "ui/ray_caster/ray_caster.h"

namespace octascope::ui {

// Composites the vessels' colours under `image`, the volume up to the vessels. If `opacity` is less
// than 1, mixes the result there with `alone`, the volume without vessels; else that may be null.
// `image.drawn` grows to contain all vessels. All images have the same size.
void merge_mask(RayImage& image, const DepthImage& vessels, float opacity, const RayImage* alone);

} // namespace octascope::ui
