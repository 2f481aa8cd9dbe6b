#include "ui/vessels/overlay/vessel_layer.h"

#include <array>

#include "ui/gl/kept_framebuffer.h"
#include "ui/gl/picture_texture.h"

namespace octascope::ui {

hal::Result<> VesselLayer::update(Splatter& splatter, const VesselScene& scene, std::uint64_t tree,
                                  float detail_px, MaskReader target) {
  const Key key{
      tree,        scene.world_from_tree, scene.camera.view_projection, scene.look, detail_px,
      scene.width, scene.height};
  if (drawn_ != key) {
    drawn_.reset();
    HAL_TRY(
        const auto account,
        splatter.draw(scene, image_, {.taken = {}, .detail_px = detail_px, .within_volume = true}));
    account_ = account;
    drawn_ = key;
    ++drawings_;
  }
  return target == MaskReader::gl && laid_ != drawings_ ? lay_into_gl(scene) : hal::Result<>{};
}

hal::Result<> VesselLayer::resize(int width, int height) {
  width_ = height_ = 0;
  framebuffer_ = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  const auto attach = [&](GLenum format, GLenum place) {
    gl::Texture texture = gl::make_picture_texture(format, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glFramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, texture.name(), 0);
    return texture;
  };
  colour_ = attach(GL_RGBA8, GL_COLOR_ATTACHMENT0);
  depth_ = attach(GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return hal::fail(hal::ErrorCode::system,
                     "vessel display: a picture of {}x{} is no complete framebuffer (status "
                     "0x{:04x}); choose a smaller size",
                     width, height, status);
  width_ = width;
  height_ = height;
  return {};
}

hal::Result<> VesselLayer::lay_into_gl(const VesselScene& scene) {
  if (!picture_) {
    HAL_TRY(auto made, SplatPicture::create());
    picture_.emplace(std::move(made));
  }
  const gl::KeptFramebuffer kept;
  if (scene.width != width_ || scene.height != height_)
    HAL_CHECK(resize(scene.width, scene.height));
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  constexpr std::array<GLfloat, 4> nothing{0, 0, 0, 0};
  constexpr GLfloat far = 1;
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_COLOR, 0, nothing.data());
  glClearBufferfv(GL_DEPTH, 0, &far);
  HAL_CHECK(picture_->draw(image_, scene.camera));
  laid_ = drawings_;
  return {};
}

DepthMask VesselLayer::stops(MaskReader target, float opacity) const {
  DepthMask stops;
  stops.version = drawings_;
  stops.opacity = opacity;
  if (target == MaskReader::processor) {
    stops.image = &image_;
  } else {
    stops.colour = colour_.name();
    stops.depth = depth_.name();
  }
  return stops;
}

} // namespace octascope::ui
