#include "ui/vessels/splatter/splat_picture.h"

#include <array>
#include <bit>
#include <cstddef>

#include "embedded_shaders.h"

namespace octascope::ui {

namespace {

// Drivers count a picture's bytes in 32 bits, with a sign; llvmpipe crashes at the next one.
constexpr std::size_t most_bytes = 0x7FFF'FFFF;

} // namespace

static_assert(std::endian::native == std::endian::little, "a pixel's colour is its first half");

hal::Result<SplatPicture> SplatPicture::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("vessel_splats", shaders::vessel_splats_frag));
  return SplatPicture{std::move(pass)};
}

hal::Result<> SplatPicture::upload(const DepthImage& image, SplatColumns columns) {
  const std::size_t bytes = static_cast<std::size_t>(image.width) *
                            static_cast<std::size_t>(image.height) * sizeof(DepthPixel);
  if (bytes > most_bytes)
    return hal::fail(hal::ErrorCode::unsupported,
                     "vessels: a picture of {}x{} has {} bytes for the processor to draw, expected "
                     "at most {}; choose a smaller size, or let GL draw all",
                     image.width, image.height, bytes, most_bytes);
  if (image.width != width_ || image.height != height_) {
    uploader_ = gl::PixelUploader::create(bytes);
    texture_ = gl::Texture::make();
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RG32UI, image.width, image.height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    width_ = image.width;
    height_ = image.height;
  }
  HAL_TRY(const void* const pixels,
          uploader_.stage({reinterpret_cast<const std::uint8_t*>(image.pixels.data()), bytes}));
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, image.width);
  glPixelStorei(GL_UNPACK_SKIP_PIXELS, columns.first);
  glTexSubImage2D(GL_TEXTURE_2D, 0, columns.first, 0, columns.end - columns.first, image.height,
                  GL_RG_INTEGER, GL_UNSIGNED_INT, pixels);
  glPixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  gl::PixelUploader::unbind();
  return {};
}

hal::Result<> SplatPicture::draw(const DepthImage& image, const Camera& camera,
                                 SplatColumns columns) {
  if (columns.end <= columns.first)
    return {};
  const int wide = columns.end - columns.first;
  glActiveTexture(GL_TEXTURE0);
  HAL_CHECK(upload(image, columns));
  pass_.use();
  glUniform1i(pass_.uniform("u_splats"), 0);
  glUniform2f(pass_.uniform("u_size"), static_cast<float>(wide), static_cast<float>(image.height));
  glUniform1i(pass_.uniform("u_first_column"), columns.first);
  // Of the perspective with these two distances: 0 at the near, 1 at the far one.
  const float range = camera.far_mm - camera.near_mm;
  glUniform2f(pass_.uniform("u_depth"), camera.far_mm / range,
              -camera.near_mm * camera.far_mm / range);
  std::array<GLint, 4> viewport{}; // fill() counts from the top of the target
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL); // a vessel that covers a part of an empty pixel is infinitely far
  glDepthMask(GL_TRUE);
  pass_.fill({viewport[0] + columns.first, 0, wide, image.height}, viewport[1] + image.height);
  glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
  glDisable(GL_DEPTH_TEST);
  return {};
}

} // namespace octascope::ui
