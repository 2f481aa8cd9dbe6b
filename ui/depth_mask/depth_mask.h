// Vessels inside a volume: where they end the rays.
//
// With a mask, a technique draws the volume only up to the nearest vessel of each pixel. The
// vessel's colour is then composited under that: the volume in front veils the vessel, and the
// vessel hides what is behind it. If the vessels' opacity is less than 1, the result is mixed with
// the picture of the volume alone.
#pragma once

#include <cstdint>

#include <GLES3/gl3.h>

#include "ui/depth_mask/depth_image.h"
#include "ui/gl/program.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// As large as the volume's picture. Borrowed for one drawing.
struct DepthMask {
  std::uint64_t version = 0; // unique for each picture of the vessels
  float opacity = 1;         // of the vessels, more than 0
  // For GL, rows from the bottom; 0 where the processor draws the volume.
  GLuint colour = 0; // RGBA: opaque or transparent
  GLuint depth = 0;  // by the camera's view_projection
  // For the processor; null where GL draws the volume.
  const DepthImage* image = nullptr;
};

// Sets the uniforms of stops.glsl in the current program. Null: no vessel ends a ray. Uses texture
// unit 3.
void set_depth_mask(const gl::Program& program, const DepthMask* stops, const Camera& camera);

} // namespace octascope::ui
