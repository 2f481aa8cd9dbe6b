// The framebuffer that is bound.
#pragma once

#include "pipeline/files/png_image.h"

namespace octascope::ui::gl {

// Clears it, and the viewport of this size, to black.
void clear_to_black(int width, int height);

// Waits until everything is drawn.
void finish();

// Its content, rows from the top; waits for the drawing. Allocates.
pipeline::Image read_framebuffer(int width, int height);

} // namespace octascope::ui::gl
