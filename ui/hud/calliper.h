// The calliper: how far two marks in the B-scan are apart.
#pragma once

#include <optional>

#include "pipeline/volume/volume_geometry.h"
#include "ui/view/fixed_text.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Assumed where the depths of a volume are in air; the simulated tissue has it, too.
inline constexpr double tissue_index = 1.38;

// Between the middles of the voxels that the marks lie in. Depth is an optical path: divided by the
// refractive index of what it passes through. Distances across are the same in every medium.
struct CalliperDistance {
  double mm = 0;                     // in the volume's own medium
  std::optional<double> tissue_mm{}; // empty: the volume's refractive index is unknown
  std::optional<double> air_mm{};
};

// Pure.
CalliperDistance calliper_distance(const ViewState& view, const pipeline::VolumeGeometry& volume);

// "0.62 mm in tissue, 0.85 mm in air".
FixedText<64> words_of(const CalliperDistance& distance);

} // namespace octascope::ui
