// The start-up picture, shown while everything else is being created.
#pragma once

#include <string_view>

#include "hal/result.h"

namespace octascope::ui {

// Draws the program's name and its current activity over the whole bound framebuffer of
// width × height pixels. Needs only a GLES 3 context and keeps no state.
// ErrorCode::unsupported: this GL cannot compile the shaders.
hal::Result<> draw_splash(int width, int height, std::string_view version, std::string_view doing);

} // namespace octascope::ui
