// What flows over the microscope's picture, in the field of the scan.
#pragma once

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout/layout.h"
#include "ui/layout/scan_field.h"

namespace octascope::ui {

// Threads: as gl/objects.h. draw() allocates nothing.
class FieldFlow {
public:
  static hal::Result<FieldFlow> create();

  // Blends what flows (EnFacePanel::flow()), with hues up to that share of the volume's depth, over
  // the microscope's picture, which fills `rect` of the bound framebuffer.
  void draw(const gl::Texture& flow, float deepest, const ScanField& field, const Rect& rect,
            int target_height) const;

private:
  explicit FieldFlow(gl::PicturePass pass);

  gl::PicturePass pass_;
  GLint corners_;
  GLint tint_place_;
};

// Of the picture in `rect`, what the field lies in.
Rect around(const ScanField& field, const Rect& rect);

} // namespace octascope::ui
