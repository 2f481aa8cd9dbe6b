// Colour and opacity of each level.
#pragma once

#include <array>
#include <optional>

#include "ui/transfer/depth_colours.h"
#include "ui/view/view_state.h"
#include "ui/view/window.h"

namespace octascope::ui {

// A transfer function sampled at sixteenths of a level, so that interpolated levels can be looked
// up and narrow windows keep their ramp.
struct TransferTable {
  static constexpr int entries_per_level = 16;
  static constexpr int entries = 255 * entries_per_level + 1;
  struct Colour {
    float red = 0;
    float green = 0;
    float blue = 0;
    bool operator==(const Colour&) const = default;
  };

  std::array<Colour, entries> colour{}; // 0…1, not premultiplied
  std::array<float, entries> opacity{}; // 0…1, over one reference step

  // Set if `colour` is grey and gets its hue from the depth. Then `window` is not.
  std::optional<DepthColours> depths;

  // Set if the table is only a display window: kernels then compute the ramp for sixteen samples at
  // once, instead of looking them up one by one.
  struct Window {
    WindowRamp ramp;
    float opacity;
  };
  std::optional<Window> window;
};

// Formula (1) of the OCT paper, as in the shaders: grey rises from 0 to 1 across the window, and
// opacity is grey · ViewState::opacity.
void make_window_table(const ViewState& view, TransferTable& table);

} // namespace octascope::ui
