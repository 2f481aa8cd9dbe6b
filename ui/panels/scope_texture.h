// The microscope's picture as a texture, converted from the camera's pixel format.
#pragma once

#include <cstddef>
#include <optional>

#include "hal/result.h"
#include "hal/scope_camera.h"
#include "ui/gl/objects.h"
#include "ui/gl/picture_pass.h"

namespace octascope::ui {

// RGB and RGBA are uploaded unchanged; YUYV and NV12 are converted on the GPU (BT.601, limited
// range, as USB and board cameras send).
//
// Threads: as gl/objects.h. Makes textures only when the picture's size or format changes.
class ScopeTexture {
public:
  static hal::Result<ScopeTexture> create();

  // Copies the frame before it returns; the bound framebuffer stays bound. ErrorCode::bad_data: the
  // frame is shorter than its format, size and stride require; the message has both lengths.
  // ErrorCode::unsupported: larger than this GL's textures.
  hal::Result<> show(const hal::ScopeFrame& frame);

  // Row 0 is the top; alpha is unspecified.
  const gl::Texture& texture() const { return colour_; }
  int width() const { return width_; }
  int height() const { return height_; }

private:
  explicit ScopeTexture(gl::PicturePass conversion);
  hal::Result<> resize(const hal::ScopeFrame& frame);
  void convert(const hal::ScopeFrame& frame) const;

  gl::PicturePass conversion_;
  struct {
    GLint luma, chroma, packed;
  } uniforms_;
  gl::Texture colour_;
  gl::Texture luma_; // these two, and the framebuffer, for YUYV and NV12
  gl::Texture chroma_;
  gl::Framebuffer framebuffer_;
  std::optional<hal::PixelFormat> format_;
  int width_ = 0;
  int height_ = 0;
};

} // namespace octascope::ui
