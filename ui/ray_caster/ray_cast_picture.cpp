#include "ui/ray_caster/ray_cast_picture.h"

#include <span>

#include "embedded_shaders.h"

#include "ui/gl/picture_texture.h"

namespace octascope::ui {

hal::Result<RayCastPicture> RayCastPicture::create() {
  auto pass = gl::PicturePass::create("ray_image", shaders::ray_image_frag);
  if (!pass)
    return tl::make_unexpected(pass.error());
  return RayCastPicture{std::move(*pass)};
}

void RayCastPicture::resize(int width, int height) {
  image_.resize(width, height);
  uploader_ = gl::PixelUploader::create(image_.rgba.size() * sizeof(std::uint32_t));
  texture_ = gl::make_picture_texture(GL_RGBA8, width, height);
}

hal::Result<> RayCastPicture::upload_image() {
  const std::span<const std::uint32_t> pixels{image_.rgba};
  if (auto ok = uploader_.stage(
          {reinterpret_cast<const std::uint8_t*>(pixels.data()), pixels.size_bytes()});
      !ok)
    return ok;
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, image_.width, image_.height, GL_RGBA, GL_UNSIGNED_BYTE,
                  nullptr);
  gl::PixelUploader::unbind();
  return {};
}

hal::Result<> RayCastPicture::update(RayCaster& caster, const VolumeScene& scene, RayMode mode,
                                     const DrawQuality& quality, const Rect& rect) {
  const VolumePictureKey key = volume_picture_key(scene, quality, rect);
  if (drawn_ == key && drawn_mode_ == mode)
    return {};
  drawn_.reset();
  if (key.width != image_.width || key.height != image_.height)
    resize(key.width, key.height);
  RaySettings settings;
  settings.mode = mode;
  settings.step_mm = scene.step_mm;
  if (auto ok = caster.draw(scene.camera, settings, image_); !ok)
    return ok;
  if (auto ok = upload_image(); !ok)
    return ok;
  drawn_ = key;
  ++drawings_;
  drawn_mode_ = mode;
  return {};
}

void RayCastPicture::composite(const Rect& rect, int target_height) const {
  pass_.blend(texture_, rect, target_height);
}

} // namespace octascope::ui
