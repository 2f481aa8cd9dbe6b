// Functions on the bound framebuffer.
#pragma once

#include "pipeline/files/png_image.h"

namespace octascope::ui::gl {

// Fills it with black and sets the viewport to its size.
void clear_to_black(int width, int height);

// Waits until the GPU has finished drawing.
void finish();

// Its content, rows from the top; waits for the drawing. Allocates.
pipeline::Image read_framebuffer(int width, int height);

} // namespace octascope::ui::gl
