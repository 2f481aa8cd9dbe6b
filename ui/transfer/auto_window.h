// Suggests a window for a volume, from its histogram.
#pragma once

#include <optional>

#include "pipeline/volume/volume.h"
#include "ui/transfer/histogram.h"

namespace octascope::ui {

struct DisplayWindow {
  float offset_db = 0;
  float size_db = 1;
};

// The lowest high peak of a volume's histogram is taken as the noise floor, and the slope below it
// as the spread of the noise. The window begins above nearly all of the noise and ends where only a
// few voxels are brighter. Empty if no B-scan is present. Pure.
std::optional<DisplayWindow> suggest_window(const LevelHistogram& histogram);
std::optional<DisplayWindow> suggest_window(const pipeline::Volume& volume);

} // namespace octascope::ui
