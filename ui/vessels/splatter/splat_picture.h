// Copies a DepthImage into the bound framebuffer with its depth, so that what GL and the processor
// draw occlude each other correctly.
#pragma once

#include "hal/result.h"
#include "ui/depth_mask/depth_image.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"
#include "ui/gl/pixel_uploader.h"
#include "ui/vessels/splatter/splat_kernels.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates when the size changes.
class SplatPicture {
public:
  static hal::Result<SplatPicture> create();

  // Draws over the whole viewport, which must be as large as the image, where the image is nearer
  // (GL_LEQUAL); colours are premultiplied. Pixels without a vessel are unchanged. Leaves the depth
  // test off. ErrorCode::unsupported: drivers do not count so many bytes.
  hal::Result<> draw(const DepthImage& image, const Camera& camera) {
    return draw(image, camera, {0, image.width});
  }
  // Only these columns.
  hal::Result<> draw(const DepthImage& image, const Camera& camera, SplatColumns columns);

private:
  explicit SplatPicture(gl::PicturePass pass) : pass_{std::move(pass)} {}
  hal::Result<> upload(const DepthImage& image, SplatColumns columns);

  gl::PicturePass pass_;
  gl::PixelUploader uploader_;
  gl::Texture texture_;
  int width_ = 0;
  int height_ = 0;
};

} // namespace octascope::ui
