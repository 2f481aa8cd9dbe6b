// Clips drawing to a rectangle during its lifetime, within what it was clipped to before.
#pragma once

#include <algorithm>
#include <array>

#include <GLES3/gl3.h>

#include "ui/layout/layout.h"

namespace octascope::ui::gl {

// Threads: as gl/objects.h.
class Scissor {
public:
  // `rect`: from the target's top left corner.
  Scissor(const Rect& rect, int target_height) : enabled_{glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE} {
    glGetIntegerv(GL_SCISSOR_BOX, box_.data());
    int left = rect.x;
    int bottom = target_height - rect.bottom();
    int right = rect.right();
    int top = bottom + rect.height;
    if (enabled_) {
      left = std::max(left, box_[0]);
      bottom = std::max(bottom, box_[1]);
      right = std::min(right, box_[0] + box_[2]);
      top = std::min(top, box_[1] + box_[3]);
    }
    glScissor(left, bottom, std::max(right - left, 0), std::max(top - bottom, 0));
    glEnable(GL_SCISSOR_TEST);
  }
  Scissor(const Scissor&) = delete;
  Scissor& operator=(const Scissor&) = delete;
  ~Scissor() {
    glScissor(box_[0], box_[1], box_[2], box_[3]);
    if (!enabled_)
      glDisable(GL_SCISSOR_TEST);
  }

private:
  bool enabled_;
  std::array<GLint, 4> box_{};
};

} // namespace octascope::ui::gl
