#include "hal/linux/kms/mode/visible_frame.h"

#include <array>
#include <utility>

#include <GLES3/gl3.h>

namespace octascope::hal::linux_backend::kms {

Result<> VisibleFrame::create(int screen_width, int screen_height, const Rectangle& part) {
  part_ = part;
  screen_height_ = screen_height;
  if (part != Rectangle{0, 0, screen_width, screen_height}) {
    glGenRenderbuffers(1, &colour_);
    glBindRenderbuffer(GL_RENDERBUFFER, colour_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, part.width, part.height);
    glGenFramebuffers(1, &framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      return fail(ErrorCode::system,
                  "kms display: a framebuffer of {}x{} is incomplete; choose a smaller mode, or no "
                  "overscan margins",
                  part.width, part.height);
  }
  glViewport(0, 0, part.width, part.height);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  return {};
}

void VisibleFrame::destroy() {
  const std::uint32_t framebuffer = std::exchange(framebuffer_, 0);
  const std::uint32_t colour = std::exchange(colour_, 0);
  if (framebuffer != 0)
    glDeleteFramebuffers(1, &framebuffer);
  if (colour != 0)
    glDeleteRenderbuffers(1, &colour);
}

void VisibleFrame::copy_to_screen() const {
  if (!has_margins())
    return;
  // Scissors would cut, masks would keep: the drawing may have left them in any state.
  const bool scissors = glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE;
  std::array<GLboolean, 4> mask{};
  glGetBooleanv(GL_COLOR_WRITEMASK, mask.data());
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);

  constexpr std::array<GLfloat, 4> black{0, 0, 0, 1};
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glClearBufferfv(GL_COLOR, 0, black.data());
  const int bottom = screen_height_ - part_.y - part_.height; // GL counts from below
  glBlitFramebuffer(0, 0, part_.width, part_.height, part_.x, bottom, part_.x + part_.width,
                    bottom + part_.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);

  glColorMask(mask[0], mask[1], mask[2], mask[3]);
  if (scissors)
    glEnable(GL_SCISSOR_TEST);
}

} // namespace octascope::hal::linux_backend::kms
