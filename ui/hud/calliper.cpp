#include "ui/hud/calliper.h"

#include <cmath>

namespace octascope::ui {

namespace {

FixedText<16> length_words(double mm) {
  FixedText<16> words;
  if (mm < 0.9995)
    words.format("{:.0f} µm", mm * 1e3);
  else
    words.format("{:.2f} mm", mm);
  return words;
}

} // namespace

CalliperDistance calliper_distance(const ViewState& view, const pipeline::VolumeGeometry& volume) {
  const double across_mm = (view.mark_2_a - view.mark_1_a) * volume.a_spacing_um * 1e-3;
  const double depth_mm = (view.mark_2_depth - view.mark_1_depth) * volume.depth_spacing_um * 1e-3;
  CalliperDistance distance{.mm = std::hypot(across_mm, depth_mm)};
  if (!volume.refractive_index)
    return distance;
  const double in_air_mm = depth_mm * *volume.refractive_index;
  const bool stored_in_air = *volume.refractive_index < 1.005; // as medium_words() tells it
  distance.air_mm = std::hypot(across_mm, in_air_mm);
  distance.tissue_mm =
      stored_in_air ? std::hypot(across_mm, in_air_mm / tissue_index) : distance.mm;
  return distance;
}

FixedText<64> words_of(const CalliperDistance& distance) {
  FixedText<64> words;
  if (!distance.tissue_mm)
    words.format("{}, refractive index unknown", length_words(distance.mm).view());
  else
    words.format("{} in tissue, {} in air", length_words(*distance.tissue_mm).view(),
                 length_words(*distance.air_mm).view());
  return words;
}

} // namespace octascope::ui
