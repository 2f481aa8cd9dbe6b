// The panels of the two crossed B-scans at the selected positions, depth downwards, depth 0 at the
// top: along the fast axis, the first A-scan at the left, and along the slow one, across all
// B-scans, the first at the left.
#pragma once

#include <array>
#include <optional>

#include "hal/result.h"
#include "ui/gl/picture_pass.h"
#include "ui/layout/crop.h"
#include "ui/layout/layout.h"
#include "ui/panels/flow_sections.h"
#include "ui/panels/state_texture.h"
#include "ui/view/view_state.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

enum class ScanDirection : std::uint8_t { fast, slow };

// Threads: as gl/objects.h. draw() allocates nothing.
class BScanPanel {
public:
  static hal::Result<BScanPanel> create();

  // What draw() needs to show flow; does nothing if it is there. ErrorCode::unsupported: this GL cannot
  // compile the shaders.
  hal::Result<> prepare_flow();

  // Fills `rect` of the bound framebuffer with what the crop leaves. Missing B-scans are hatched;
  // saturated ones are marked at the upper border where others are beside them. `flow`: of the same
  // volume, and fetched for this view, shown over it, B-scans of which it could not be told marked at
  // the lower border; null: not shown.
  void draw(const VolumeTexture& volume, const StateTexture& states, ScanDirection direction,
            const ViewState& view, const Crop& crop, const Rect& rect, int target_height,
            const FlowSections* flow = nullptr) const;

private:
  // A shader and where it takes what from.
  struct Pass {
    explicit Pass(gl::PicturePass made);
    gl::PicturePass pass;
    GLint levels, window, corner, across, down;
    GLint states, hatch, mark_height, mark, seam; // −1 where nothing is marked
    GLint flow, untold_height;                    // −1 where no flow is shown
  };
  struct Passes {
    Pass marking;
    Pass plain; // where every B-scan is good
  };
  explicit BScanPanel(Passes passes);
  static hal::Result<Passes> make(bool flow);
  static void set_marks(const Pass& pass, const StateTexture& states, ScanDirection direction,
                        const Rect& rect, int target_height);

  Passes passes_;
  std::optional<Passes> with_flow_; // empty until there is some
};

} // namespace octascope::ui
