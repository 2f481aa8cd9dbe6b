#include "ui/volume/volume_picture.h"

#include <array>
#include <string_view>

#include "embedded_shaders.h"

#include "ui/dither/soften.h"
#include "ui/gl/kept_framebuffer.h"
#include "ui/gl/picture_texture.h"
#include "ui/ray_caster/ray_frame.h"

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

// To the bound framebuffer, as what is drawn into.
void attach(GLuint colour) {
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
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

} // namespace

hal::Result<VolumePicture> VolumePicture::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("composite", shaders::composite_frag));
  HAL_TRY(auto soften, gl::PicturePass::create("soften", shaders::soften_frag));
  HAL_TRY(auto mix, gl::PicturePass::create("vessel_mix", shaders::vessel_mix_frag));
  return VolumePicture{std::move(pass), std::move(soften), std::move(mix)};
}

VolumePicture::VolumePicture(gl::PicturePass pass, gl::PicturePass soften,
                             gl::PicturePass vessel_mix)
    : pass_{std::move(pass)}, soften_{std::move(soften)}, vessel_mix_{std::move(vessel_mix)},
      format_{accumulation_format()}, depth_possible_{has_extension("GL_EXT_color_buffer_float")} {}

hal::Result<> VolumePicture::resize(int width, int height) {
  framebuffer_ = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  colour_ = gl::make_picture_texture(format_, width, height);
  grained_ = {};
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.name(), 0);
  if (depth_possible_) {
    depth_ = gl::make_picture_texture(GL_R32F, width, height);
    // Neither filterable everywhere nor of use between near and far.
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, depth_.name(), 0);
  }
  nearest_ = gl::make_picture_texture(GL_DEPTH_COMPONENT24, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, nearest_.name(), 0);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return hal::fail(hal::ErrorCode::system,
                     "volume display: a picture of {}x{} is no complete framebuffer (status "
                     "0x{:04x}); choose a smaller size",
                     width, height, status);
  width_ = width;
  height_ = height;
  return {};
}

GLuint VolumePicture::grained_texture() {
  if (!grained_)
    grained_ = gl::make_picture_texture(format_, width_, height_);
  return grained_.name();
}

// From `grained_` into the bound framebuffer.
void VolumePicture::soften(const DepthMask* vessels) const {
  soften_.use();
  glUniform1i(soften_.uniform("u_picture"), 0);
  glUniform1i(soften_.uniform("u_stopped"), vessels != nullptr ? 1 : 0);
  glUniform1i(soften_.uniform("u_vessels"), 1);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, vessels != nullptr ? vessels->colour : 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, grained_.name());
  soften_.fill({0, 0, width_, height_}, height_);
}

void VolumePicture::clear() const {
  constexpr std::array<GLfloat, 4> nothing{0, 0, 0, 0};
  constexpr std::array<GLfloat, 4> far{no_depth, no_depth, no_depth, no_depth};
  glClearBufferfv(GL_COLOR, 0, nothing.data());
  if (depth_)
    glClearBufferfv(GL_COLOR, 1, far.data());
}

// Under what the rays have gathered; and the whole of it over the volume alone.
void VolumePicture::add_vessels(const DepthMask& vessels, const VolumePicture* alone) const {
  const auto bind = [](GLint unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
  };
  glEnable(GL_BLEND);
  pass_.use();
  glUniform1i(pass_.uniform("u_picture"), 0);
  bind(0, vessels.colour);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  pass_.fill({0, 0, width_, height_}, height_);
  if (alone != nullptr) {
    vessel_mix_.use();
    glUniform1i(vessel_mix_.uniform("u_picture"), 0);
    glUniform1i(vessel_mix_.uniform("u_vessels"), 1);
    bind(1, vessels.colour);
    bind(0, alone->colour_texture());
    glBlendColor(0, 0, 0, vessels.opacity);
    glBlendFunc(GL_ONE_MINUS_CONSTANT_ALPHA, GL_CONSTANT_ALPHA);
    vessel_mix_.fill({0, 0, width_, height_}, height_);
  }
  glDisable(GL_BLEND);
}

hal::Result<> VolumePicture::update(VolumeTechniques& techniques, const VolumeScene& scene,
                                    const DrawQuality& quality, const Rect& rect,
                                    const VolumePicture* alone) {
  const VolumePictureKey key = volume_picture_key(scene, quality, rect);
  if (drawn_ == key)
    return {};
  drawn_.reset();
  HAL_TRY(
      const auto technique,
      techniques.get(scene.view.technique, scene.flow != nullptr ? WithFlow::yes : WithFlow::no));
  const gl::KeptFramebuffer kept;
  if (key.width != width_ || key.height != height_)
    HAL_CHECK(resize(key.width, key.height));
  constexpr std::array<GLenum, 2> buffers{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  glDrawBuffers(depth_ ? 2 : 1, buffers.data());
  const bool grained = technique->dithers() && is_grained(scene.step_mm, scene.volume.geometry());
  if (grained)
    attach(grained_texture());
  clear();
  glDrawBuffers(depth_ && technique->writes_depth() ? 2 : 1, buffers.data());
  technique->draw(scene);
  glDrawBuffers(1, buffers.data());
  if (grained) {
    attach(colour_.name());
    soften(scene.vessels);
  }
  if (scene.vessels != nullptr) {
    add_vessels(*scene.vessels, alone);
  }
  drawn_ = key;
  ++drawings_;
  return {};
}

void VolumePicture::composite(const Rect& rect, int target_height) const {
  pass_.blend(colour_, rect, target_height);
}

} // namespace octascope::ui
