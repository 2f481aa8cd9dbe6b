// A render target for vessels: colour and depth, to be composited or read back.
#pragma once

#include <utility>
#include <vector>

#include "hal/result.h"
#include "pipeline/files/png_image.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/vessels/scene/vessel_method.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// 8-bit RGBA and 24 bits of depth, textures both.
//
// Threads: as gl/objects.h.
class VesselPicture {
public:
  // ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<VesselPicture> create();

  // Resizes and clears the picture and draws the scene; the bound framebuffer and the viewport
  // stay. ErrorCode::system: this GL cannot render to a picture of that size. Other errors: the
  // method's.
  hal::Result<SegmentCounts> draw(VesselMethod& method, const VesselScene& scene);

  // Rows from the bottom. Opaque colours or none, and depths by the camera's view_projection.
  GLuint colour_texture() const { return colour_.name(); }
  GLuint depth_texture() const { return depth_.name(); }
  int width() const { return width_; }
  int height() const { return height_; }

  // RGB on black, rows from the top. Waits for the drawing; allocates.
  pipeline::Image read_colour() const;
  // Window depth, 0…1 from near to far plane, 1 where nothing is; rows from the top. As above.
  std::vector<float> read_depth() const;

private:
  explicit VesselPicture(gl::PicturePass depth_pass) : depth_pass_{std::move(depth_pass)} {}
  hal::Result<> resize(int width, int height);

  gl::PicturePass depth_pass_;
  gl::Texture colour_;
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
  int width_ = 0;
  int height_ = 0;
};

} // namespace octascope::ui
