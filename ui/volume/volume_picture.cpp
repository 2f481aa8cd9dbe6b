#include "ui/volume/volume_picture.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "embedded_shaders.h"
#include <fmt/format.h>

#include "ui/gl/picture_texture.h"

namespace octascope::ui {

namespace {

bool has_extension(std::string_view name) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i)
    if (name == reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i))))
      return true;
  return false;
}

// Hundreds of faint planes add up here. Software rasterisers cut 16-bit results off instead of
// rounding them, which costs a picture of 256 planes 2 % of its opacity, while 32 bits take them no
// longer; so 32 bits wherever GL can blend and filter them.
GLenum accumulation_format() {
  const bool floats = has_extension("GL_EXT_color_buffer_float");
  if (floats && has_extension("GL_EXT_float_blend") && has_extension("GL_OES_texture_float_linear"))
    return GL_RGBA32F;
  return floats || has_extension("GL_EXT_color_buffer_half_float") ? GL_RGBA16F : GL_RGBA8;
}

// Puts back the framebuffer that was bound.
class KeptFramebuffer {
public:
  KeptFramebuffer() { glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &name_); }
  KeptFramebuffer(const KeptFramebuffer&) = delete;
  KeptFramebuffer& operator=(const KeptFramebuffer&) = delete;
  ~KeptFramebuffer() { glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(name_)); }

private:
  GLint name_ = 0;
};

} // namespace

VolumePictureKey volume_picture_key(const ViewState& view, const DrawQuality& quality,
                                    std::uint64_t upload, const EyePicture& picture) {
  const auto pixels = [&](int length) {
    return std::max(1,
                    static_cast<int>(std::lround(static_cast<float>(length) * quality.resolution)));
  };
  return {upload,
          view.yaw_deg,
          view.tilt_deg,
          view.distance,
          view.window_offset_db,
          view.window_size_db,
          view.opacity,
          view.technique,
          view.transfer,
          view.colour_map,
          quality.steps,
          pixels(picture.width),
          pixels(picture.height),
          picture.aspect,
          picture.eye,
          picture.eye == Eye::centre ? 0 : view.parallax_deg};
}

hal::Result<VolumePicture> VolumePicture::create() {
  auto stack = PlaneStack::create();
  if (!stack)
    return tl::make_unexpected(stack.error());
  auto pass = gl::PicturePass::create("composite", shaders::composite_frag);
  if (!pass)
    return tl::make_unexpected(pass.error());
  return VolumePicture{std::move(*stack), std::move(*pass)};
}

VolumePicture::VolumePicture(PlaneStack stack, gl::PicturePass pass)
    : stack_{std::move(stack)}, pass_{std::move(pass)}, format_{accumulation_format()} {}

hal::Result<> VolumePicture::resize(int width, int height) {
  colour_ = gl::make_picture_texture(format_, width, height);
  framebuffer_ = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.name(), 0);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return hal::fail(hal::Fault::system,
                     fmt::format("volume display: a picture of {}x{} is no complete framebuffer "
                                 "(status 0x{:04x}); choose a smaller size",
                                 width, height, status));
  width_ = width;
  height_ = height;
  return {};
}

hal::Result<> VolumePicture::update(const VolumeTexture& volume, std::uint64_t upload,
                                    const ViewState& view, const DrawQuality& quality,
                                    const EyePicture& picture) {
  const VolumePictureKey key = volume_picture_key(view, quality, upload, picture);
  if (drawn_ == key)
    return {};
  const KeptFramebuffer kept;
  if (key.width != width_ || key.height != height_)
    if (auto ok = resize(key.width, key.height); !ok)
      return ok;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  stack_.draw(volume,
              make_camera(view, box_extents_mm(volume.geometry()), picture.aspect, picture.eye),
              view, quality.steps);
  drawn_ = key;
  return {};
}

void VolumePicture::composite(const Rect& rect, int target_height) const {
  pass_.blend(colour_, rect, target_height);
}

} // namespace octascope::ui
