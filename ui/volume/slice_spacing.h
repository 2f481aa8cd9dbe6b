// Which of the volume's own slices a stack is made of. Pure.
#pragma once

#include <glm/vec3.hpp>

#include "pipeline/volume/volume.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// Slices perpendicular to one of the volume's axes, from the eye on. If the step is longer than the
// volume's spacing, only every second, third … slice is drawn.
struct SliceSpacing {
  int axis;         // of the world (ui/view/camera.h): 0 fast, 1 depth, 2 slow
  float direction;  // +1 or −1: away from the eye along that axis
  int slices;       // of the volume along it
  int drawn;        // how many of them
  float spacing_mm; // between those drawn
  float half_mm;    // half of the box's extent

  // The i-th on the way from the eye, on the world's axis: the middle of a voxel.
  float offset_mm(int i) const;
};

SliceSpacing space_slices(const Camera& camera, const pipeline::VolumeGeometry& geometry,
                          float step_mm, int most);

} // namespace octascope::ui
