// The en-face panel: the slab of the volume that a surgeon looks for (ui/panels/projection.h), with
// automatic contrast; fast axis to the right, B-scans downwards, the first at the top.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/threads/work_team.h"
#include "pipeline/volume/volume.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout/crop.h"
#include "ui/layout/layout.h"
#include "ui/panels/state_texture.h"
#include "ui/panels/tissue_map.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates only when the geometry changes.
class EnFacePanel {
public:
  static hal::Result<EnFacePanel> create();

  // Projects on the CPU (about a millisecond for 300 × 80 × 512) and uploads the projection.
  // `tissue`: of the same volume, which differs from that of the last show() in those B-scans alone,
  // in any if there are none. The work is shared among the team.
  void show(const pipeline::Volume& volume, const TissueMap& tissue,
            std::span<const pipeline::BScanRange> changed = {}, WorkTeam* team = nullptr);

  // Of the last show(): 1 for each B-scan of which it changed the projection.
  std::span<const std::uint8_t> changed_rows() const { return changed_; }

  // Fills `rect` of the bound framebuffer with what the crop leaves; missing B-scans are hatched, saturated ones marked at
  // the right border.
  void draw(const StateTexture& states, const Crop& crop, const Rect& rect,
            int target_height) const;

private:
  explicit EnFacePanel(gl::PicturePass pass, gl::PicturePass plain);
  void draw_plain(const Crop& crop, const Rect& rect, int target_height) const;
  void allocate(int a_scans, int b_scans);
  void compare_rows();

  gl::PicturePass pass_;
  gl::PicturePass plain_; // where every B-scan is good
  gl::Texture projection_;
  std::vector<std::uint8_t> levels_; // projected
  std::vector<std::uint8_t> wanted_; // by B-scan: whether it has to be projected anew
  std::vector<std::uint8_t> grey_;   // the same with its contrast
  std::vector<std::uint8_t> before_; // of the show() before the last
  std::vector<std::uint8_t> changed_;
  int a_scans_ = 0;
  int b_scans_ = 0;
  struct {
    GLint projection, states, corner, extent, hatch, mark_width, mark, seam;
  } uniforms_;
  struct {
    GLint projection, corner, extent;
  } plain_uniforms_;
};

} // namespace octascope::ui
