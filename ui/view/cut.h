// The volume cut open at the shown B-scan: what lies between it and the eye is left out.
#pragma once

#include <algorithm>

#include "pipeline/volume/volume_geometry.h"
#include "ui/view/camera.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// The part of the slow axis that is drawn, as shares of its length.
struct SlowRange {
  float from = 0;
  float to = 1;

  bool whole() const { return from <= 0 && to >= 1; }
  float face() const { return from > 0 ? from : to; } // where it is cut
  bool operator==(const SlowRange&) const = default;
};

// The cut runs through the middle of the view's B-scan, and its face looks at the eye.
inline SlowRange kept_range(const ViewState& view, const Camera& camera,
                            const pipeline::VolumeGeometry& geometry) {
  if (!view.cut)
    return {};
  const int b_scan = std::clamp(view.b_scan, 0, geometry.b_scans - 1);
  const float at = (static_cast<float>(b_scan) + 0.5F) / static_cast<float>(geometry.b_scans);
  const float eye = 0.5F + camera.eye.z / box_extents_mm(geometry).z;
  return eye > at ? SlowRange{0, at} : SlowRange{at, 1};
}

} // namespace octascope::ui
