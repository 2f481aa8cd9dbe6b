#include "ui/panels/scope_texture.h"

#include "embedded_shaders.h"

#include "ui/gl/kept_framebuffer.h"
#include "ui/gl/picture_texture.h"

namespace octascope::ui {

namespace {

using hal::PixelFormat;

bool is_yuv(PixelFormat format) {
  return format == PixelFormat::yuyv || format == PixelFormat::nv12;
}

std::size_t row_bytes(const hal::ScopeFrame& frame) {
  const auto width = static_cast<std::size_t>(frame.width);
  switch (frame.format) {
  case PixelFormat::rgb8: return 3 * width;
  case PixelFormat::rgba8: return 4 * width;
  case PixelFormat::yuyv: return 4 * ((width + 1) / 2);
  case PixelFormat::nv12: return 2 * ((width + 1) / 2);
  }
  return 0;
}

std::size_t row_count(const hal::ScopeFrame& frame) {
  const auto height = static_cast<std::size_t>(frame.height);
  return frame.format == PixelFormat::nv12 ? height + (height + 1) / 2 : height;
}

hal::Result<> check(const hal::ScopeFrame& frame) {
  if (frame.width < 1 || frame.height < 1 || frame.stride_bytes < 0 ||
      static_cast<std::size_t>(frame.stride_bytes) < row_bytes(frame))
    return hal::fail(
        hal::ErrorCode::bad_data,
        "microscope picture: {}x{} with a stride of {} bytes, expected a stride of at least {}",
        frame.width, frame.height, frame.stride_bytes, row_bytes(frame));
  const std::size_t needed =
      static_cast<std::size_t>(frame.stride_bytes) * (row_count(frame) - 1) + row_bytes(frame);
  if (frame.pixels.size() < needed)
    return hal::fail(hal::ErrorCode::bad_data,
                     "microscope picture: {} bytes for {}x{}, expected {}", frame.pixels.size(),
                     frame.width, frame.height, needed);
  return {};
}

struct Plane {
  GLenum format;
  int texel_bytes;
  int width; // in texels
  int height;
  const std::byte* pixels;
};

void upload(const gl::Texture& texture, const Plane& plane, int stride_bytes) {
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (stride_bytes % plane.texel_bytes == 0) {
    glPixelStorei(GL_UNPACK_ROW_LENGTH, stride_bytes / plane.texel_bytes);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, plane.width, plane.height, plane.format,
                    GL_UNSIGNED_BYTE, plane.pixels);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    return;
  }
  // GL counts a row's length in texels.
  for (int y = 0; y < plane.height; ++y)
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, y, plane.width, 1, plane.format, GL_UNSIGNED_BYTE,
                    plane.pixels + static_cast<std::ptrdiff_t>(y) * stride_bytes);
}

gl::Texture make_plane(GLenum format, int width, int height) {
  gl::Texture texture = gl::make_picture_texture(format, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

} // namespace

hal::Result<ScopeTexture> ScopeTexture::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("scope_yuv", shaders::scope_yuv_frag));
  return ScopeTexture{std::move(pass)};
}

ScopeTexture::ScopeTexture(gl::PicturePass conversion)
    : conversion_{std::move(conversion)}, uniforms_{conversion_.uniform("u_luma"),
                                                    conversion_.uniform("u_chroma"),
                                                    conversion_.uniform("u_packed")} {}

hal::Result<> ScopeTexture::resize(const hal::ScopeFrame& frame) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (frame.width > largest || frame.height > largest)
    return hal::fail(
        hal::ErrorCode::unsupported,
        "microscope picture: {}x{}, this GL draws at most {}x{}; set the camera to a smaller size",
        frame.width, frame.height, largest, largest);
  format_ = frame.format;
  width_ = frame.width;
  height_ = frame.height;
  const GLenum kept = frame.format == PixelFormat::rgb8 ? GL_RGB8 : GL_RGBA8;
  colour_ = gl::make_picture_texture(kept, width_, height_);
  luma_ = {};
  chroma_ = {};
  framebuffer_ = {};
  if (!is_yuv(frame.format))
    return {};
  const int pairs = (width_ + 1) / 2;
  if (frame.format == PixelFormat::yuyv) {
    luma_ = make_plane(GL_RGBA8, pairs, height_);
  } else {
    luma_ = make_plane(GL_R8, width_, height_);
    chroma_ = make_plane(GL_RG8, pairs, (height_ + 1) / 2);
  }
  const gl::KeptFramebuffer kept_framebuffer;
  framebuffer_ = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.name(), 0);
  return {};
}

void ScopeTexture::convert(const hal::ScopeFrame& frame) const {
  const int pairs = (width_ + 1) / 2;
  const bool packed = frame.format == PixelFormat::yuyv;
  if (packed) {
    upload(luma_, {GL_RGBA, 4, pairs, height_, frame.pixels.data()}, frame.stride_bytes);
  } else {
    upload(luma_, {GL_RED, 1, width_, height_, frame.pixels.data()}, frame.stride_bytes);
    const std::byte* const chroma =
        frame.pixels.data() + static_cast<std::ptrdiff_t>(height_) * frame.stride_bytes;
    upload(chroma_, {GL_RG, 2, pairs, (height_ + 1) / 2, chroma}, frame.stride_bytes);
  }
  const gl::KeptFramebuffer kept_framebuffer;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  conversion_.use();
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, packed ? luma_.name() : chroma_.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, luma_.name());
  glUniform1i(uniforms_.luma, 0);
  glUniform1i(uniforms_.chroma, 1);
  glUniform1i(uniforms_.packed, packed ? 1 : 0);
  conversion_.fill({0, 0, width_, height_}, height_);
}

hal::Result<> ScopeTexture::show(const hal::ScopeFrame& frame) {
  HAL_CHECK(check(frame));
  if (format_ != frame.format || frame.width != width_ || frame.height != height_)
    HAL_CHECK(resize(frame));
  switch (frame.format) {
  case PixelFormat::rgb8:
    upload(colour_, {GL_RGB, 3, width_, height_, frame.pixels.data()}, frame.stride_bytes);
    break;
  case PixelFormat::rgba8:
    upload(colour_, {GL_RGBA, 4, width_, height_, frame.pixels.data()}, frame.stride_bytes);
    break;
  case PixelFormat::yuyv:
  case PixelFormat::nv12: convert(frame); break;
  }
  return {};
}

} // namespace octascope::ui
