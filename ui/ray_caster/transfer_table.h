// From a level to what it looks like.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "ui/ray_caster/ray_frame.h"
#include "ui/view_state.h"
#include "ui/window.h"

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

  // Where the table is nothing but a display window: sixteen samples are looked up one by one, but
  // a ramp is computed for all at once.
  struct Window {
    WindowRamp ramp;
    float opacity;
  };
  std::optional<Window> window;
};

// The paper's formula (1), as the shaders have it: grey rises from 0 to 1 across the window, and
// opacity is grey · ViewState::opacity.
void make_window_table(const ViewState& view, TransferTable& table);

// What the kernels read: one entry for each of TransferTable's.
struct StepTable {
  // Opacity of one step in the upper 16 bits, red or grey in the lower ones, both 65535 for 1.
  std::array<std::uint32_t, TransferTable::entries> opacity_and_red{};
  std::array<std::uint32_t, TransferTable::entries> green_and_blue{}; // upper and lower 16 bits
  bool grey = true;                                                   // all channels are the same
  // How many entries that can be seen lie before each: a range without any is empty.
  std::array<std::uint16_t, TransferTable::entries + 1> visible_before{};

  // grey · polynomial(grey) instead of the tables, where that comes within 1e-4 of the opacity.
  struct Ramp {
    WindowRamp window;
    std::array<float, ramp_terms> opacity;
  };
  std::optional<Ramp> ramp;

  bool empty(int lowest_level, int highest_level) const {
    constexpr int per_level = TransferTable::entries_per_level;
    return visible_before[static_cast<std::size_t>(highest_level * per_level) + 1] ==
           visible_before[static_cast<std::size_t>(lowest_level * per_level)];
  }
};

// Opacity over `steps` reference steps: 1 − (1 − opacity)^steps.
void make_step_table(const TransferTable& transfer, float steps, StepTable& table);

} // namespace octascope::ui
