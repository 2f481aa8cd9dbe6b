#include "sim/phantoms/phantom_nail_fold.h"

#include <cmath>
#include <numbers>

#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float round_edge_mm = 0.42F;

void append(std::vector<VesselSegment>& to, const std::vector<VesselSegment>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

// A hairpin: out to the fold's edge and back, wavering, the way back wider.
void append_loop(std::vector<VesselSegment>& to, float x_mm, float tip_y_mm, std::uint64_t key) {
  constexpr int steps = 14;
  constexpr float radius_mm = 0.022F;
  const auto part = [&](std::uint64_t which) {
    return static_cast<float>(unit_interval(hash(key, which)));
  };
  const float half_width = 0.035F + 0.025F * part(1);
  const float length = 0.38F + 0.35F * part(2);
  const float lean = 0.3F * (part(3) - 0.5F);
  const auto at = [&](int step) {
    // −1 … 1 along the hairpin; 0 is its tip.
    const float t = 2 * static_cast<float>(step) / steps - 1;
    const float back = 1 - std::sqrt(1 - t * t); // from the tip, rounded
    const float waver = 0.012F * std::sin(9 * back + 6 * part(4));
    return VesselPoint{x_mm + half_width * std::sin(pi / 2 * std::clamp(2.2F * t, -1.0F, 1.0F)) +
                           lean * length * back + waver,
                       tip_y_mm - length * back, 0.15F + 0.2F * back};
  };
  for (int step = 0; step < steps; ++step)
    to.push_back({at(step), at(step + 1), step < steps / 2 ? radius_mm : 1.4F * radius_mm});
}

} // namespace

NailFold::NailFold(std::uint64_t seed) : seed_(hash(seed, 0x0a11)) {
  std::vector<VesselSegment> skin;
  for (std::uint64_t i = 0; i < 16; ++i) {
    const float x = -3.0F + 0.4F * (static_cast<float>(i) +
                                    0.3F * static_cast<float>(unit_interval(hash(seed_, i))));
    append_loop(skin, x, fold_y_mm(x) - 0.28F, hash(seed_, i, 1));
  }
  append(skin, grow_vessels({-1.6F, -1.15F, 0.38F}, 0.1F, 0.06F, 1.2F, seed_ + 1));
  append(skin, grow_vessels({1.7F, -1.35F, 0.42F}, 3.0F, 0.07F, 1.3F, seed_ + 2));
  skin_vessels_ = VesselBed(std::move(skin));
  std::vector<VesselSegment> bed;
  for (std::uint64_t i = 0; i < 5; ++i)
    append(bed, grow_vessels({-1.6F + 0.8F * static_cast<float>(i), -0.5F, 0.18F}, pi / 2, 0.045F,
                             1.1F, hash(seed_, i, 2)));
  bed_vessels_ = VesselBed(std::move(bed));
}

float NailFold::nail_top_mm(float x_mm, float y_mm) {
  // Under the skin the nail dips towards its root.
  const float under = std::max(0.15F - y_mm, 0.0F);
  return 0.74F + 0.05F * x_mm * x_mm + 0.16F * under * under;
}

float NailFold::nail_thickness_mm(float y_mm) {
  const float from_root = y_mm - root_y_mm;
  return from_root <= 0 ? 0 : plate_mm * std::min(std::sqrt(from_root / 1.1F), 1.0F);
}

float NailFold::fold_y_mm(float x_mm) const {
  return 0.12F + 0.1F * x_mm * x_mm * 0.6F + 0.05F * smooth_noise(seed_ + 10, x_mm * 3, 0.5F);
}

float NailFold::skin_top_mm(float x_mm, float y_mm) const {
  const float flat = 0.36F + 0.05F * x_mm * x_mm +
                     0.022F * smooth_noise(seed_ + 11, x_mm * 3.5F, y_mm * 5) +
                     0.012F * smooth_noise(seed_ + 12, x_mm * 9, y_mm * 11);
  // The edge rolls down to the nail.
  const float t = std::clamp(1 - (fold_y_mm(x_mm) - y_mm) / round_edge_mm, 0.0F, 1.0F);
  const float drop = nail_top_mm(x_mm, y_mm) - flat;
  return flat + drop * (1 - std::sqrt(std::max(1 - t * t, 0.0F)));
}

void NailFold::fill(Column& column, double /*phase*/, float x_mm, float y_mm) const {
  column.clear();
  const bool open = y_mm > fold_y_mm(x_mm);
  const bool has_nail = y_mm > root_y_mm;
  if (!open)
    fill_skin(column, x_mm, y_mm, has_nail ? nail_top_mm(x_mm, y_mm) : 20.0F);
  if (has_nail)
    fill_nail(column, x_mm, y_mm, open);
}

void NailFold::fill_skin(Column& column, float x_mm, float y_mm, float bottom_mm) const {
  const float top = skin_top_mm(x_mm, y_mm);
  const float papillae = 0.025F * smooth_noise(seed_ + 13, x_mm * 11, y_mm * 11);
  const float horny = std::min(top + 0.03F, bottom_mm);
  const float epidermis = std::min(top + 0.125F + papillae, bottom_mm);
  column.add(Layer{top, horny, 34, 1});
  column.add(Layer{horny, epidermis, 11, 0.8F});
  column.add(Layer{epidermis, bottom_mm, 22, 1.15F, Grain::granules, 0.55F});
  column.add(Surface{top, 75, 1});
  skin_vessels_.fill(column, x_mm, y_mm, top, bottom_mm,
                     Layer{.backscatter_counts = 60, .attenuation_per_mm = 3});
}

void NailFold::fill_nail(Column& column, float x_mm, float y_mm, bool open) const {
  const float top = nail_top_mm(x_mm, y_mm);
  const float bottom = top + nail_thickness_mm(y_mm);
  column.add(Layer{top, bottom, 8.5F, 0.5F, Grain::lamellae, 0.75F});
  column.add(Surface{top, open ? 190.0F : 45.0F, 0.95F});
  column.add(Surface{bottom, 35, 1});
  const float ridge = 0.03F * smooth_noise(seed_ + 14, x_mm * 7, y_mm * 0.5F);
  const float matrix = bottom + 0.09F + ridge;
  column.add(Layer{bottom, matrix, 10, 0.6F});
  column.add(Layer{matrix, 20, 24, 1.5F, Grain::granules, 0.5F});
  bed_vessels_.fill(column, x_mm, y_mm, bottom, 20,
                    Layer{.backscatter_counts = 60, .attenuation_per_mm = 3});
}

std::vector<VesselSegment> NailFold::vessels() const {
  std::vector<VesselSegment> placed;
  append_below(placed, skin_vessels_, [&](float x_mm, float y_mm) -> std::optional<float> {
    if (y_mm > fold_y_mm(x_mm))
      return std::nullopt;
    return skin_top_mm(x_mm, y_mm);
  });
  append_below(placed, bed_vessels_, [&](float x_mm, float y_mm) -> std::optional<float> {
    if (y_mm <= root_y_mm)
      return std::nullopt;
    return nail_top_mm(x_mm, y_mm) + nail_thickness_mm(y_mm);
  });
  return placed;
}

Look NailFold::look(float x_mm, float y_mm) const {
  constexpr Rgb skin{0.86F, 0.63F, 0.52F};
  constexpr Rgb red{0.74F, 0.28F, 0.24F};
  constexpr Rgb nail{0.91F, 0.70F, 0.64F};
  constexpr Rgb lunula{0.95F, 0.87F, 0.82F};
  const float edge = fold_y_mm(x_mm);
  if (y_mm <= edge) {
    const float blotch = 0.5F + 0.5F * rough_noise(seed_ + 15, x_mm * 1.2F, y_mm * 1.2F);
    const float seam = std::exp(-(edge - y_mm) / 0.1F);
    const Rgb base = mix(mix(skin, red, 0.22F * blotch), Rgb{0.93F, 0.80F, 0.72F}, 0.6F * seam);
    return {mix(base, red, 0.9F * skin_vessels_.visibility(x_mm, y_mm, 0.35F)),
            -skin_top_mm(x_mm, y_mm), 0.04F};
  }
  const float moon = 1 / (1 + std::exp((std::hypot(x_mm * 0.75F, y_mm + 0.7F) - 1.7F) / 0.06F));
  const float groove = 0.5F + 0.5F * smooth_noise(seed_ + 14, x_mm * 7, y_mm * 0.5F);
  const float shadow = std::exp(-(y_mm - edge) / 0.12F);
  Rgb plate = mix(mix(nail, lunula, 0.7F * moon), red, 0.1F * groove);
  plate = mix(plate, red, 0.3F * bed_vessels_.visibility(x_mm, y_mm, 0.4F));
  return {mix(plate, Rgb{0.45F, 0.2F, 0.16F}, 0.55F * shadow),
          -nail_top_mm(x_mm, y_mm) + 0.01F * groove, 0.7F};
}

} // namespace octascope::sim
