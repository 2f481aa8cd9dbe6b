#include "ui/drawing_budget.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

float affordable_resolution(bool software, int width, int height) {
  if (!software)
    return 1;
  constexpr float affordable_pixels = 640.0F * 360.0F;
  const float pixels = std::max(static_cast<float>(width) * static_cast<float>(height), 1.0F);
  return std::min(std::sqrt(affordable_pixels / pixels), 1.0F);
}

} // namespace octascope::ui
