// Restores the framebuffer that was bound.
#pragma once

#include <GLES3/gl3.h>

namespace octascope::ui::gl {

// Threads: as gl/objects.h.
class KeptFramebuffer {
public:
  KeptFramebuffer() { glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &name_); }
  KeptFramebuffer(const KeptFramebuffer&) = delete;
  KeptFramebuffer& operator=(const KeptFramebuffer&) = delete;
  ~KeptFramebuffer() { glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(name_)); }

private:
  GLint name_ = 0;
};

} // namespace octascope::ui::gl
