// The display window in the form that shaders use.
#pragma once

#include "pipeline/volume/level_scale.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Formula (1) of the OCT paper on a normalised sample t = count / 255 of the volume:
// opacity = clamp(scale · t + offset, 0, 1).
struct WindowRamp {
  float scale;
  float offset;
};

inline WindowRamp window_ramp(const ViewState& view) {
  return {255 * pipeline::level_step_db / view.window_size_db,
          (pipeline::lowest_level_db - view.window_offset_db) / view.window_size_db};
}

} // namespace octascope::ui
