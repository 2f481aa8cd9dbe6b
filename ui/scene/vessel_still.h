// A still picture of a vessel tree alone, with a scale bar.
#pragma once

#include <utility>

#include "hal/result.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_renderer.h"
#include "ui/gl/picture_pass.h"
#include "ui/vessels/pictures/vessel_picture.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class VesselStill {
public:
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<VesselStill> create();

  // Draws over the whole bound framebuffer, on the display's background, and leaves the viewport as
  // large as the scene. The bar at the lower left shows a length in millimetres, which holds where
  // `mm_per_pixel` does. Errors as VesselPicture::draw() and Fonts::create().
  hal::Result<SegmentCounts> draw(VesselMethod& method, const VesselScene& scene,
                                  float mm_per_pixel);

private:
  VesselStill(VesselPicture picture, gl::PicturePass pass, CanvasRenderer canvas_renderer)
      : picture_{std::move(picture)}, pass_{std::move(pass)}, canvas_renderer_{
                                                                  std::move(canvas_renderer)} {}
  void lay_over_background(const Rect& rect) const;

  VesselPicture picture_;
  gl::PicturePass pass_;
  CanvasRenderer canvas_renderer_;
};

} // namespace octascope::ui
