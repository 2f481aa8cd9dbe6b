#include "ui/ray_caster/transfer_table.h"

#include <algorithm>
#include <cmath>

#include "ui/window.h"

namespace octascope::ui {

namespace {

std::uint32_t to_16_bits(float share) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(share, 0.0F, 1.0F) * 65535.0F));
}

float opacity_over(float opacity, float steps) {
  // log(0) is undefined: a fully opaque voxel keeps a transparency that no display can show.
  const float transparency = std::max(1.0F - opacity, 1e-5F);
  return -std::expm1(steps * std::log(transparency));
}

} // namespace

void make_window_table(const ViewState& view, TransferTable& table) {
  const WindowRamp window = window_ramp(view);
  for (std::size_t i = 0; i < TransferTable::entries; ++i) {
    const float level = static_cast<float>(i) / TransferTable::entries_per_level;
    const float grey = std::clamp(level / 255 * window.scale + window.offset, 0.0F, 1.0F);
    table.colour[i] = {grey, grey, grey};
    table.opacity[i] = grey * view.opacity;
  }
}

void make_step_table(const TransferTable& transfer, float steps, StepTable& table) {
  table.grey = true;
  float last_opacity = -1;
  std::uint32_t alpha = 0;
  for (std::size_t i = 0; i < TransferTable::entries; ++i) {
    if (transfer.opacity[i] != last_opacity) { // whole stretches are the same
      last_opacity = transfer.opacity[i];
      alpha = to_16_bits(opacity_over(last_opacity, steps));
    }
    const TransferTable::Colour& colour = transfer.colour[i];
    table.opacity_and_red[i] = (alpha << 16U) | to_16_bits(colour.red);
    table.green_and_blue[i] = (to_16_bits(colour.green) << 16U) | to_16_bits(colour.blue);
    table.grey = table.grey && colour.red == colour.green && colour.red == colour.blue;
  }
  std::uint16_t visible = 0;
  for (std::size_t i = 0; i < TransferTable::entries; ++i) {
    table.visible_before[i] = visible;
    visible = static_cast<std::uint16_t>(visible + (transfer.opacity[i] > 0 ? 1 : 0));
  }
  table.visible_before[TransferTable::entries] = visible;
}

} // namespace octascope::ui
