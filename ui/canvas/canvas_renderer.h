// Draws a Canvas with GLES 3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

  // Draws into one eye's part of the bound framebuffer, only within `parts` of it, which do not
  // overlap; of a picture that is squeezed for one of two eyes, all of it. begin() of the canvas must have had the frame's width and height. Allocates when there
  // is more to draw than ever before.
  void draw(const Canvas& canvas, const EyeFrame& frame, int target_height,
            std::span<const Rect> parts);
  void draw(const Canvas& canvas, const EyeFrame& frame, int target_height) {
    draw(canvas, frame, target_height, std::span{&frame.target, 1});
  }

private:
  // Triangles that are drawn by one call.
  struct Run {
    Rect clip;
    GLuint texture = 0;
    std::size_t first = 0; // of the indices
    std::size_t count = 0;
  };

  explicit CanvasRenderer(gl::Program program);
  void make_room(std::size_t indices, std::size_t commands);
  void collect(const Canvas& canvas, const EyeFrame& frame, const Rect& part);

  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
  gl::Buffer indices_;
  std::vector<std::uint16_t> drawn_; // indices
  std::vector<Run> runs_;
};

} // namespace octascope::ui
