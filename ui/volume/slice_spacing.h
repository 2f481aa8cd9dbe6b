// Which of the volume's slices a slice stack draws. Pure.
#pragma once

#include <glm/vec3.hpp>

#include "pipeline/volume/volume.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// Slices perpendicular to one of the volume's axes, ordered away from the eye. If the step is
// longer than the distance between slices, only every second, third … slice is drawn.
struct SliceSpacing {
  int axis;         // of the world (ui/view/camera.h): 0 fast, 1 depth, 2 slow
  float direction;  // +1 or −1: away from the eye along that axis
  int slices;       // of the volume along the axis
  int drawn;        // the number of slices drawn
  float spacing_mm; // between drawn slices
  float half_mm;    // half of the box's extent

  // Position on the axis of the i-th drawn slice from the eye: the middle of a voxel.
  float offset_mm(int i) const;
};

SliceSpacing space_slices(const Camera& camera, const pipeline::VolumeGeometry& geometry,
                          float step_mm, int most);

} // namespace octascope::ui
