// The geometry of rays, for both the processor's ray caster and the shader. Pure.
#pragma once

#include <glm/vec3.hpp>

#include "pipeline/volume/volume.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// Axes in the order depth, fast, slow; lengths along them in cells (pipeline/volume/occupancy.h),
// so depth bin 0 is centred at 0, A-scan 0 and B-scan 0 at 1.
struct RayGeometry {
  glm::vec3 lower; // the visible box: without the blank depth bins
  glm::vec3 upper;
  glm::vec3 eye;
  glm::vec3 forward; // cells per mm
  glm::vec3 right;
  glm::vec3 up;
  glm::vec3 mm; // of one cell
  // The distance along each axis over which shading takes the gradient.
  glm::vec3 gradient_cells;
  // Range of the depth cue along the view: from the box's nearest to its farthest distance.
  float cue_near_mm;
  float cue_per_mm;
};

RayGeometry ray_geometry(const pipeline::VolumeGeometry& geometry, const Camera& camera);

// Which of the eight octants of directions (DistancesAhead) can contain rays of the picture, one
// bit each.
unsigned octants_of_rays(const pipeline::VolumeGeometry& geometry, const Camera& camera);

// One and a half mean spacings, so that a slope is lit the same from every direction.
float gradient_mm(const pipeline::VolumeGeometry& geometry);

} // namespace octascope::ui
