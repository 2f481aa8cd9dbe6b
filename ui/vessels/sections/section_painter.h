// Draws vessels of flat pictures into layers that are laid over them.
#pragma once

#include <span>

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/gl/program.h"
#include "ui/layout/layout.h"
#include "ui/vessels/sections/picture_place.h"

namespace octascope::ui {

// A picture with transparency, kept for as long as what is in it holds.
struct SectionLayer {
  gl::Framebuffer framebuffer;
  gl::Texture colour; // premultiplied, rows from the bottom
  gl::Texture depth;
  int width = 0;
  int height = 0;
};

// Lines are antialiased and run around what segments cover together.
//
// Threads: as gl/objects.h. draw() makes textures when the layer's size changes, and allocates
// nothing of its own.
class SectionPainter {
public:
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<SectionPainter> create();

  struct Style {
    float line_px; // width of the lines
    float line_opacity;
    float reach_px; // from a vessel's wall to the plane, where nothing is left; 0 from above
    float opacity;  // of all

    bool operator==(const Style&) const = default;
  };
  // Redraws the layer, `width` × `height` pixels large. The framebuffer binding is kept.
  // ErrorCode::system: this GL cannot render to a picture of that size.
  hal::Result<> draw(SectionLayer& layer, std::span<const PlacedMark> marks, const Style& style,
                     int width, int height);

  // Blends the layer over `rect` of the bound framebuffer; of it only what lies in `covered`, in the
  // layer's pixels from its top left corner.
  void blend(const SectionLayer& layer, const Rect& covered, const Rect& rect,
             int target_height) const;

private:
  SectionPainter(gl::Program program, gl::PicturePass over);

  gl::Program program_;
  gl::PicturePass over_;
  gl::VertexArray vertex_array_;
  gl::Buffer marks_;
  struct {
    GLint size, half_line, line_opacity, reach, opacity;
  } uniforms_;
};

} // namespace octascope::ui
