// A transfer function for the ray-casting kernels, for one step length.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "ui/ray_caster/ray_frame.h"
#include "ui/transfer/transfer_table.h"
#include "ui/transfer/visible_levels.h"

namespace octascope::ui {

// One entry for each of TransferTable's.
struct StepTable {
  // Opacity of one step in the upper 16 bits, red or grey in the lower ones; 65535 is 1.
  std::array<std::uint32_t, TransferTable::entries> opacity_and_red{};
  std::array<std::uint32_t, TransferTable::entries> green_and_blue{}; // upper and lower 16 bits
  bool grey = true;                                                   // all channels are equal
  VisibleLevels visible{};

  // grey · polynomial(grey), instead of the tables, if that is within 1e-4 of the opacity.
  struct Ramp {
    WindowRamp window;
    std::array<float, ramp_terms> opacity;
  };
  std::optional<Ramp> ramp;
};

// What is seen of flow (ui/transfer/flow_look.h), by its count in the same parts.
struct FlowTable {
  // Opacity of one step in the upper 16 bits, the weight in the lower ones; 65535 is 1.
  std::array<std::uint32_t, TransferTable::entries> opacity_and_weight{};
};

// `opacity`: over one reference step, of what flows for certain.
void make_flow_table(float opacity, float steps, FlowTable& table);

// Opacity over `steps` reference steps: 1 − (1 − opacity)^steps.
void make_step_table(const TransferTable& transfer, float steps, StepTable& table);

} // namespace octascope::ui
