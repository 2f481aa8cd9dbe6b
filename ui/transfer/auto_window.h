// Suggests a display window for a volume from its histogram.
#pragma once

#include <optional>

#include "pipeline/volume/volume.h"
#include "ui/transfer/histogram.h"

namespace octascope::ui {

struct DisplayWindow {
  float offset_db = 0;
  float size_db = 1;
};

// The lowest high peak of a volume's histogram is the noise floor, and the levels below the peak
// show how far the noise spreads. The window begins above nearly all of the noise and ends where
// only a few voxels are brighter. Empty if there is no B-scan. Pure.
std::optional<DisplayWindow> suggest_window(const LevelHistogram& histogram);
std::optional<DisplayWindow> suggest_window(const pipeline::Volume& volume);

} // namespace octascope::ui
