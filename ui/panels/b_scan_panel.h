// The panels of the two crossed B-scans at the selected positions, depth downwards, depth 0 at the
// top: along the fast axis, the first A-scan at the left, and along the slow one, across all
// B-scans, the first at the left.
#pragma once

#include "hal/result.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout/crop.h"
#include "ui/layout/layout.h"
#include "ui/panels/state_texture.h"
#include "ui/view/view_state.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

enum class ScanDirection : std::uint8_t { fast, slow };

// Threads: as gl/objects.h. draw() allocates nothing.
class BScanPanel {
public:
  static hal::Result<BScanPanel> create();

  // Fills `rect` of the bound framebuffer with what the crop leaves. Missing B-scans are hatched;
  // saturated ones are marked at the upper border where others are beside them.
  void draw(const VolumeTexture& volume, const StateTexture& states, ScanDirection direction,
            const ViewState& view, const Crop& crop, const Rect& rect, int target_height) const;

private:
  // A shader and where it takes what from.
  struct Pass {
    explicit Pass(gl::PicturePass made);
    gl::PicturePass pass;
    GLint levels, window, corner, across, down;
  };
  BScanPanel(gl::PicturePass pass, gl::PicturePass plain);
  void set_marks(const StateTexture& states, ScanDirection direction, const Rect& rect,
                 int target_height) const;

  Pass marking_;
  Pass plain_; // where every B-scan is good
  struct {
    GLint states, hatch, mark_height, mark, seam;
  } marks_;
};

} // namespace octascope::ui
