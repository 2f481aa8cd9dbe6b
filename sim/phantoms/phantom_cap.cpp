#include "sim/phantoms/phantom_cap.h"

#include <cmath>
#include <numbers>

#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float outer_radius_mm = 2.9F;
constexpr float inner_radius_mm = 2.6F;
constexpr float apex_mm = 0.32F;
constexpr int ribs = 18;
constexpr float ribs_from_mm = 0.72F;
constexpr float rib_height_mm = 0.1F;
constexpr float rim_mm = 2.45F; // the dome ends in a flat rim

float dome_mm(float radius_mm, float r_mm) {
  const float r = std::min(r_mm, rim_mm);
  return radius_mm - std::sqrt(radius_mm * radius_mm - r * r);
}

float smooth_step(float t) {
  const float s = std::clamp(t, 0.0F, 1.0F);
  return s * s * (3 - 2 * s);
}

} // namespace

PlasticCap::PlasticCap(std::uint64_t seed) : seed_(hash(seed, 0xca9)) {
  std::vector<VesselSegment> channels;
  for (std::uint64_t i = 0; i < 3; ++i) {
    const float angle = 2 * pi * static_cast<float>(i) / 3 + 0.5F;
    const auto tree = grow_vessels({0, 0, 0.2F}, angle, 0.055F, 0.8F, hash(seed_, i));
    channels.insert(channels.end(), tree.begin(), tree.end());
  }
  channels_ = VesselBed(std::move(channels));
}

float PlasticCap::outer_mm(float x_mm, float y_mm) {
  const float r = std::hypot(x_mm, y_mm);
  const float wave = 0.5F + 0.5F * std::cos(static_cast<float>(ribs) * std::atan2(y_mm, x_mm));
  const float rib = smooth_step((wave - 0.35F) / 0.3F) * smooth_step((r - ribs_from_mm) / 0.12F);
  // A ring and a raised button in the middle, as the mould leaves them.
  const float ring = smooth_step(1 - std::abs(r - 0.45F) / 0.09F);
  return apex_mm + dome_mm(outer_radius_mm, r) - rib_height_mm * rib - 0.06F * ring;
}

float PlasticCap::inner_mm(float x_mm, float y_mm) {
  return apex_mm + wall_mm + dome_mm(inner_radius_mm, std::hypot(x_mm, y_mm));
}

void PlasticCap::fill(Column& column, double /*phase*/, float x_mm, float y_mm) const {
  column.clear();
  constexpr float step_mm = 0.01F;
  const float outer = outer_mm(x_mm, y_mm);
  const float inner = inner_mm(x_mm, y_mm);
  const float slope =
      std::hypot(outer_mm(x_mm + step_mm, y_mm) - outer, outer_mm(x_mm, y_mm + step_mm) - outer) /
      step_mm;
  const float shine = std::exp(-slope * slope / (2 * 0.12F * 0.12F));
  // Filled plastic: cloudy, with flow lines that follow the mould.
  column.add(Layer{outer, inner, 12, 0.7F, Grain::lamellae, 0.5F});
  column.add(Layer{outer, outer + 0.012F, 30, 0.7F});
  column.add(Surface{outer, 30 + 320 * shine, 0.9F});
  const bool in_rib = std::min(std::abs(x_mm), std::abs(y_mm)) < inner_rib_mm;
  if (in_rib) {
    column.add(Layer{inner, 20, 13, 0.7F, Grain::granules, 0.3F});
  } else {
    column.add(Layer{inner - 0.012F, inner, 24, 0.7F});
    column.add(Surface{inner, 25 + 60 * shine, 0.9F});
  }
  channels_.fill(column, x_mm, y_mm, outer, inner - 0.04F,
                 Layer{.backscatter_counts = 45, .attenuation_per_mm = 1.5F});
}

std::vector<VesselSegment> PlasticCap::vessels() const {
  std::vector<VesselSegment> placed;
  append_below(placed, channels_,
               [](float x_mm, float y_mm) -> std::optional<float> { return outer_mm(x_mm, y_mm); });
  return placed;
}

Look PlasticCap::look(float x_mm, float y_mm) const {
  constexpr Rgb plastic{0.16F, 0.42F, 0.70F};
  constexpr Rgb table{0.30F, 0.31F, 0.33F};
  const float r = std::hypot(x_mm, y_mm);
  if (r > rim_mm) {
    const float fleck = 0.04F * rough_noise(seed_ + 5, x_mm * 8, y_mm * 8);
    return {{table.r + fleck, table.g + fleck, table.b + fleck}, -3, 0};
  }
  const float cross = std::min(std::abs(x_mm), std::abs(y_mm)) < inner_rib_mm ? 0.12F : 0.0F;
  const Rgb wall = mix(plastic, Rgb{0.6F, 0.8F, 0.95F}, cross);
  return {mix(wall, Rgb{0.85F, 0.25F, 0.2F}, 0.5F * channels_.visibility(x_mm, y_mm, 0.4F)),
          -outer_mm(x_mm, y_mm), 0.8F};
}

} // namespace octascope::sim
