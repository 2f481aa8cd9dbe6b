// A transfer function as the ray-casting kernels read it, for one length of step.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "ui/ray_caster/ray_frame.h"
#include "ui/transfer/transfer_table.h"

namespace octascope::ui {

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
