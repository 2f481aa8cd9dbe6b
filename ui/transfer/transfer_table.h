// From a level to what it looks like.
#pragma once

#include <array>
#include <optional>

#include "ui/view/view_state.h"
#include "ui/view/window.h"

namespace octascope::ui {

// A transfer function, sampled at sixteenths of a level, so that interpolated levels can be looked
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

  // Set if the table is only a display window: sixteen samples are looked up one by one, but a ramp
  // is computed for all at once.
  struct Window {
    WindowRamp ramp;
    float opacity;
  };
  std::optional<Window> window;
};

// The paper's formula (1), as in the shaders: grey rises from 0 to 1 across the window, and opacity
// is grey · ViewState::opacity.
void make_window_table(const ViewState& view, TransferTable& table);

} // namespace octascope::ui
