// Vessels inside a volume: where they end the rays, and the colour behind what the rays gathered.
//
// A technique given such a mask draws the volume up to the nearest vessel of each pixel, and
// nothing behind it. The vessel's colour is then composited under that: tissue in front of a vessel
// veils it, and the vessel hides what is behind it. With a vessel opacity below 1, that picture is
// mixed with the one of the volume alone.
#pragma once

#include <cstdint>

#include <GLES3/gl3.h>

#include "ui/depth_mask/depth_image.h"
#include "ui/gl/program.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// As large as the volume's picture. Borrowed for one drawing.
struct DepthMask {
  std::uint64_t version = 0; // unique for each picture of vessels
  float opacity = 1;         // of vessels, more than 0
  // For GL, rows from the bottom; 0 where the processor draws the volume.
  GLuint colour = 0; // RGBA: opaque or nothing
  GLuint depth = 0;  // by the camera's view_projection
  // For the processor: null where GL draws the volume.
  const DepthImage* image = nullptr;
};

// Sets the uniforms of stops.glsl for the current program; null: no vessel ends a ray. Uses texture
// unit 3.
void set_depth_mask(const gl::Program& program, const DepthMask* stops, const Camera& camera);

} // namespace octascope::ui
