// Draws a Canvas with GLES 3.
#pragma once

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/gl/program.h"
#include "ui/hud/canvas.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class CanvasRenderer {
public:
  static hal::Result<CanvasRenderer> create();

  // Into the bound framebuffer, which has that size.
  void draw(const Canvas& canvas, int width, int height) const;

private:
  explicit CanvasRenderer(gl::Program program);

  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
  gl::Buffer indices_;
};

} // namespace octascope::ui
