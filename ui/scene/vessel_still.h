// A vessel tree alone, with a scale bar: for saved pictures.
#pragma once

#include <utility>

#include "hal/result.h"
#include "ui/gl/picture_pass.h"
#include "ui/hud/canvas.h"
#include "ui/hud/canvas_renderer.h"
#include "ui/vessels/pictures/vessel_picture.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class VesselStill {
public:
  // ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<VesselStill> create();

  // Draws over the whole of the bound framebuffer, on the display's background, with a bar at the
  // lower left that is one millimetre where `mm_per_pixel` holds. Leaves the viewport as large as
  // the scene. Errors as VesselPicture::draw() and Fonts::create().
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
