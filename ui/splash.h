// The first picture, while everything else is being made.
#pragma once

#include <string_view>

#include "hal/result.h"

namespace octascope::ui {

// Draws the program's name and the present step over the whole of the bound framebuffer of width ×
// height pixels. Needs only a GLES 3 context, and keeps nothing. ErrorCode::unsupported: this GL
// cannot compile our shaders.
hal::Result<> draw_splash(int width, int height, std::string_view version, std::string_view doing);

} // namespace octascope::ui
