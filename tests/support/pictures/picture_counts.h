// Pixels of a part of a picture, counted.
#pragma once

#include "pipeline/files/png_image.h"
#include "ui/canvas/palette.h"
#include "ui/layout/layout.h"

namespace octascope::tests {

// Pixels of `where` (within the picture) whose channels are all within `tolerance` of `colour`.
int count_colour(const pipeline::Image& picture, const ui::Rect& where, ui::Colour colour,
                 int tolerance = 6);

// Pixels of `where` of which a channel differs by more than `tolerance`; the pictures are of one
// size.
int count_different(const pipeline::Image& a, const pipeline::Image& b, const ui::Rect& where,
                    int tolerance);

} // namespace octascope::tests
