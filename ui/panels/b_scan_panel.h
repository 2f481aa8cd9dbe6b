// The panel of the B-scan at the selected position: fast axis to the right, depth downwards; the
// first A-scan is at the left, depth 0 at the top.
#pragma once

#include "hal/result.h"
#include "pipeline/volume/volume.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout/layout.h"
#include "ui/view/view_state.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

// Threads: as gl/objects.h. draw() allocates nothing.
class BScanPanel {
public:
  static hal::Result<BScanPanel> create();

  // Fills `rect` of the bound framebuffer; a missing B-scan is hatched.
  void draw(const VolumeTexture& volume, pipeline::BScanState state, const ViewState& view,
            const Rect& rect, int target_height) const;

private:
  explicit BScanPanel(gl::PicturePass pass);
  gl::PicturePass pass_;
  struct {
    GLint levels, window, slow, missing, hatch;
  } uniforms_;
};

} // namespace octascope::ui
