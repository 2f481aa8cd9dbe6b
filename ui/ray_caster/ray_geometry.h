// The geometry of rays, shared by the processor's ray caster and the shader's. Pure.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/volume/volume.h"
#include "ui/view/camera.h"
#include "ui/view/cut.h"

namespace octascope::ui {

// Axes in the order depth, fast, slow. Lengths along them are in cells
// (pipeline/volume/occupancy.h), so the middle of depth bin 0 is at 0, the middles of A-scan 0 and
// B-scan 0 are at 1.
struct RayGeometry {
  glm::vec3 lower; // the box that is shown: excludes the blank depth bins
  glm::vec3 upper;
  // Where a cut's faces lie on the fast and the slow axis, far away where it has none. Rays begin where
  // they leave the cut, that is at the first face that they reach.
  bool is_cut;
  glm::vec2 cut;
  glm::vec3 eye;
  glm::vec3 forward; // cells per mm
  glm::vec3 right;
  glm::vec3 up;
  glm::vec3 mm;   // of one cell
  glm::vec3 lamp; // the direction to it, of length 1 in mm: beside the eye, above it to the left
  // Distances along the view where the depth cue begins and ends: the box's nearest and farthest.
  float cue_near_mm;
  float cue_per_mm;
};

RayGeometry ray_geometry(const pipeline::VolumeGeometry& geometry, const Camera& camera,
                         const CutAway& away = {});

// The octants of directions (see DistancesAhead) that a picture's rays can have, one bit each.
unsigned octants_of_rays(const pipeline::VolumeGeometry& geometry, const Camera& camera);

} // namespace octascope::ui
