#include "ui/ray_caster/step_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "ui/transfer/flow_look.h"

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

// Newton's interpolation of opacity / grey at Chebyshev's points, then powers of grey.
std::array<double, ramp_terms> interpolate_opacity(float opacity, float steps) {
  std::array<double, ramp_terms> at{};
  std::array<double, ramp_terms> difference{};
  for (std::size_t i = 0; i < ramp_terms; ++i) {
    at[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / ramp_terms);
    difference[i] =
        static_cast<double>(opacity_over(static_cast<float>(at[i]) * opacity, steps)) / at[i];
  }
  for (std::size_t order = 1; order < ramp_terms; ++order)
    for (std::size_t i = ramp_terms - 1; i >= order; --i)
      difference[i] = (difference[i] - difference[i - 1]) / (at[i] - at[i - order]);
  std::array<double, ramp_terms> powers{};
  for (std::size_t i = ramp_terms; i-- > 0;) { // Horner: powers · (grey − at[i]) + difference[i]
    for (std::size_t k = ramp_terms - 1; k > 0; --k)
      powers[k] = powers[k - 1] - at[i] * powers[k];
    powers[0] = difference[i] - at[i] * powers[0];
  }
  return powers;
}

std::optional<StepTable::Ramp> fit_ramp(const TransferTable::Window& window, float steps) {
  constexpr float most_error = 1e-4F;
  constexpr int checks = 128;
  const auto powers = interpolate_opacity(window.opacity, steps);
  StepTable::Ramp ramp{window.ramp, {}};
  std::ranges::transform(powers, ramp.opacity.begin(),
                         [](double power) { return static_cast<float>(power); });
  for (int i = 0; i <= checks; ++i) {
    const float grey = static_cast<float>(i) / checks;
    float sum = 0;
    for (std::size_t k = ramp_terms; k-- > 0;)
      sum = sum * grey + ramp.opacity[k];
    if (!(std::abs(sum * grey - opacity_over(grey * window.opacity, steps)) < most_error))
      return std::nullopt;
  }
  return ramp;
}

} // namespace

void make_step_table(const TransferTable& transfer, float steps, StepTable& table) {
  table.grey = true;
  table.ramp = transfer.window ? fit_ramp(*transfer.window, steps) : std::nullopt;
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
  find_visible_levels(transfer, table.visible);
}

void make_flow_table(float opacity, float steps, FlowTable& table) {
  constexpr auto last = static_cast<float>(TransferTable::entries - 1);
  float last_weight = -1;
  std::uint32_t alpha = 0;
  for (std::size_t i = 0; i < TransferTable::entries; ++i) {
    const float weight = flow_weight(static_cast<float>(i) / last);
    if (weight != last_weight) { // whole stretches are the same
      last_weight = weight;
      alpha = weight > 0 ? to_16_bits(opacity_over(weight * opacity, steps)) : 0;
    }
    table.opacity_and_weight[i] = (alpha << 16U) | to_16_bits(weight);
  }
}

} // namespace octascope::ui
