// Textures that hold a picture.
#pragma once

#include <GLES3/gl3.h>

#include "ui/gl/objects.h"

namespace octascope::ui::gl {

// Without mipmaps, filtered linearly, clamped at the edges. Left bound to GL_TEXTURE_2D.
//
// Threads: as gl/objects.h.
Texture make_picture_texture(GLenum format, int width, int height);

} // namespace octascope::ui::gl
