// The volume cut open: at the shown B-scan, or at both crossed ones, with a corner left out. What lies
// between the cut and the eye is not drawn.
#pragma once

#include <algorithm>

#include <glm/vec2.hpp>

#include "pipeline/volume/volume_geometry.h"
#include "ui/view/camera.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// What a cut takes away: all that lies between two places on the fast axis and between two on the slow
// one, at every depth. Places are shares of an axis' length; at the eye's side it reaches beyond the box,
// and rays are taken to begin in it, so that each leaves it once.
struct CutAway {
  glm::vec2 from{0}; // fast, slow
  glm::vec2 to{0};

  bool nothing() const { return from == to; }
  // Whether there is a face across that axis (0 fast, 1 slow), and where.
  bool has_face(int axis) const { return from[axis] > 0 || to[axis] < 1; }
  float face(int axis) const { return from[axis] > 0 ? from[axis] : to[axis]; }
  bool operator==(const CutAway&) const = default;
};

// The cut runs through the middle of the view's B-scan, and of the crossed one; its faces look at the eye.
inline CutAway cut_away(const ViewState& view, const Camera& camera,
                        const pipeline::VolumeGeometry& geometry) {
  constexpr float before = -1, behind = 2; // anywhere outside the box
  CutAway away;
  const auto open = [&](int axis, int index, int count, float eye_mm, float extent_mm) {
    const float at =
        (static_cast<float>(std::clamp(index, 0, count - 1)) + 0.5F) / static_cast<float>(count);
    const bool beyond = 0.5F + eye_mm / extent_mm > at;
    away.from[axis] = beyond ? at : before;
    away.to[axis] = beyond ? behind : at;
  };
  if (view.cut == CutShape::none)
    return away;
  const glm::vec3 extents = box_extents_mm(geometry);
  open(1, view.b_scan, geometry.b_scans, camera.eye.z, extents.z);
  if (view.cut == CutShape::corner)
    open(0, view.a_scan, geometry.a_scans, camera.eye.x, extents.x);
  else
    away.from[0] = before, away.to[0] = behind;
  return away;
}

} // namespace octascope::ui
