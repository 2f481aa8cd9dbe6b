// The en-face panel: the slab of the volume that a surgeon looks for (ui/panels/projection.h), with
// automatic contrast; fast axis to the right, B-scans downwards, the first at the top. Over it, dimmed,
// what flows, coloured by its depth below the surface.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/threads/work_team.h"
#include "pipeline/volume/volume.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout/crop.h"
#include "ui/layout/layout.h"
#include "ui/panels/flow_projection.h"
#include "ui/panels/state_texture.h"
#include "ui/panels/tissue_map.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates only when the geometry changes.
class EnFacePanel {
public:
  static hal::Result<EnFacePanel> create();

  // What show() and draw() need of volumes with flow; does nothing if it is there.
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  hal::Result<> prepare_flow();

  // Projects on the CPU (about a millisecond for 300 × 80 × 512) and uploads the projection.
  // `tissue`: of the same volume, which differs from that of the last show() in those B-scans alone,
  // in any if there are none. The work is shared among the team. `with_flow`: else flow is taken for absent.
  void show(const pipeline::Volume& volume, const TissueMap& tissue,
            std::span<const pipeline::BScanRange> changed = {}, WorkTeam* team = nullptr,
            bool with_flow = true);

  // Of a volume that is still coming (ComingRuns), for its show().
  void bring_ahead(const pipeline::Volume& coming, std::uint64_t number, int finished) {
    coming_.bring(coming, number, finished);
  }

  // Of the last volume shown: what flows, a texel each A-scan (FlowFromAbove); nothing if it has none or
  // was shown without.
  const gl::Texture& flow() const { return flow_projection_; }
  std::span<const FlowFromAbove> flow_from_above() const { return flow_; }

  // Of the last show(): 1 for each B-scan of which it changed the projection.
  std::span<const std::uint8_t> changed_rows() const { return changed_; }

  // Fills `rect` of the bound framebuffer with what the crop leaves; missing B-scans are hatched, saturated ones marked at
  // the right border. `deepest_flow`: the share of the volume's depth to which the hues of what flows
  // reach, and those of which that could not be told are marked at the left border; empty: no flow.
  void draw(const StateTexture& states, const Crop& crop, const Rect& rect, int target_height,
            std::optional<float> deepest_flow = {}) const;

private:
  // A shader and where it takes what from; −1 where it takes none.
  struct Pass {
    explicit Pass(gl::PicturePass made);
    gl::PicturePass pass;
    GLint projection, states, corner, extent, hatch, mark_width, mark, seam, flow, dimmed,
        tint_place;
  };
  struct Passes {
    Pass marking;
    Pass plain; // where every B-scan is good
  };
  explicit EnFacePanel(Passes passes);
  static hal::Result<Passes> make(bool flow);
  static void set_marks(const Pass& pass, const StateTexture& states, const Rect& rect,
                        int target_height);
  void allocate(int a_scans, int b_scans);
  void show_flow(const pipeline::Volume& volume, const TissueMap& tissue,
                 std::span<const ComingRuns::Run> ahead, WorkTeam* team);
  void compare_rows();

  Passes passes_;
  std::optional<Passes> with_flow_; // empty until there is some
  gl::Texture projection_;
  gl::Texture flow_projection_;
  std::vector<std::uint8_t> levels_; // projected
  std::vector<std::uint8_t> wanted_; // by B-scan: whether it has to be projected anew
  std::vector<std::uint8_t> grey_;   // the same with its contrast
  std::vector<std::uint8_t> before_; // of the show() before the last
  std::vector<std::uint8_t> changed_;
  std::vector<FlowFromAbove> flow_; // empty where the volume has none
  std::vector<FlowFromAbove> flow_before_;
  ComingRuns coming_;
  int a_scans_ = 0;
  int b_scans_ = 0;
};

} // namespace octascope::ui
