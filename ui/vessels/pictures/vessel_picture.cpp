#include "ui/vessels/pictures/vessel_picture.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "embedded_shaders.h"

#include "ui/gl/framebuffer.h"
#include "ui/gl/picture_texture.h"

namespace octascope::ui {

namespace {

// Puts back the framebuffer and the viewport.
class KeptTarget {
public:
  KeptTarget() {
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
    glGetIntegerv(GL_VIEWPORT, viewport_.data());
  }
  KeptTarget(const KeptTarget&) = delete;
  KeptTarget& operator=(const KeptTarget&) = delete;
  ~KeptTarget() {
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  }

private:
  GLint framebuffer_ = 0;
  std::array<GLint, 4> viewport_{};
};

void filter_nothing() {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

hal::Result<> check_framebuffer(int width, int height) {
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE)
    return {};
  return hal::fail(hal::ErrorCode::system,
                   "vessels: a picture of {}x{} is no complete framebuffer (status 0x{:04x}); "
                   "choose a smaller size",
                   width, height, status);
}

} // namespace

hal::Result<VesselPicture> VesselPicture::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("depth_bits", shaders::depth_bits_frag));
  return VesselPicture{std::move(pass)};
}

hal::Result<> VesselPicture::resize(int width, int height) {
  framebuffer_ = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  colour_ = gl::make_picture_texture(GL_RGBA8, width, height);
  filter_nothing();
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.name(), 0);
  depth_ = gl::make_picture_texture(GL_DEPTH_COMPONENT24, width, height);
  filter_nothing();
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.name(), 0);
  width_ = width;
  height_ = height;
  return check_framebuffer(width, height);
}

hal::Result<SegmentCounts> VesselPicture::draw(VesselMethod& method, const VesselScene& scene) {
  const KeptTarget kept;
  if (scene.width != width_ || scene.height != height_)
    if (auto made = resize(scene.width, scene.height); !made) {
      width_ = 0; // no picture of that size: try again next time
      return tl::make_unexpected(made.error());
    }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  glClearColor(0, 0, 0, 0);
  glClearDepthf(1);
  glDepthMask(GL_TRUE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  return method.draw(scene);
}

pipeline::Image VesselPicture::read_colour() const {
  const KeptTarget kept;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  return gl::read_framebuffer(width_, height_);
}

std::vector<float> VesselPicture::read_depth() const {
  const KeptTarget kept;
  const auto target = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, target.name());
  const gl::Texture bits = gl::make_picture_texture(GL_R32UI, width_, height_);
  filter_nothing();
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, bits.name(), 0);
  depth_pass_.use();
  glUniform1i(depth_pass_.uniform("u_depth"), 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, depth_.name());
  glDisable(GL_BLEND);
  depth_pass_.fill({0, 0, width_, height_}, height_);
  const auto w = static_cast<std::size_t>(width_);
  const auto h = static_cast<std::size_t>(height_);
  std::vector<std::array<std::uint32_t, 4>> texels(w * h);
  glReadPixels(0, 0, width_, height_, GL_RGBA_INTEGER, GL_UNSIGNED_INT, texels.data());
  std::vector<float> depth(w * h);
  for (std::size_t y = 0; y < h; ++y) // GL's rows run from the bottom
    for (std::size_t x = 0; x < w; ++x)
      depth[y * w + x] = std::bit_cast<float>(texels[(h - 1 - y) * w + x][0]);
  return depth;
}

} // namespace octascope::ui
