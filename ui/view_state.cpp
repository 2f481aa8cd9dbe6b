#include "ui/view_state.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

ViewState ViewState::clamped() const {
  ViewState v = *this;
  v.yaw_deg = std::remainder(v.yaw_deg, 360.0F);
  v.tilt_deg = std::clamp(v.tilt_deg, -89.0F, 89.0F);
  v.distance = std::clamp(v.distance, 0.6F, 8.0F);
  v.window_offset_db = std::clamp(v.window_offset_db, -40.0F, 87.0F);
  v.window_size_db = std::clamp(v.window_size_db, 1.0F, 128.0F);
  v.planes = std::clamp(v.planes, 16, 1024);
  v.volume_resolution = std::clamp(v.volume_resolution, 0.25F, 1.0F);
  v.opacity = std::clamp(v.opacity, 0.01F, 1.0F);
  v.b_scan = std::max(v.b_scan, 0);
  return v;
}

} // namespace octascope::ui
