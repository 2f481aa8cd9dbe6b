// Draws a Canvas with GLES 3.
#pragma once

#include "hal/result.h"
#include "ui/canvas/canvas.h"
#include "ui/gl/objects.h"
#include "ui/gl/program.h"
#include "ui/layout/stereo.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class CanvasRenderer {
public:
  static hal::Result<CanvasRenderer> create();

  // Draws into one eye's part of the bound framebuffer. begin() of the canvas must have had the
  // frame's width and height.
  void draw(const Canvas& canvas, const EyeFrame& frame, int target_height) const;

private:
  explicit CanvasRenderer(gl::Program program);

  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
  gl::Buffer indices_;
};

} // namespace octascope::ui
