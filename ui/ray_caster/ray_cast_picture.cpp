#include "ui/ray_caster/ray_cast_picture.h"

#include <algorithm>
#include <span>

#include "embedded_shaders.h"

#include "ui/gl/picture_texture.h"

namespace octascope::ui {

hal::Result<RayCastPicture> RayCastPicture::create(std::size_t helpers,
                                                   const pipeline::ThreadSetup& setup,
                                                   TransferSet transfers) {
  auto caster = RayCaster::create(helpers, setup);
  if (!caster)
    return tl::make_unexpected(caster.error());
  auto pass = gl::PicturePass::create("ray_image", shaders::ray_image_frag);
  if (!pass)
    return tl::make_unexpected(pass.error());
  return RayCastPicture{std::move(*caster), std::move(*pass), std::move(transfers)};
}

RayCastPicture::RayCastPicture(RayCaster caster, gl::PicturePass pass, TransferSet transfers)
    : caster_{std::move(caster)}, pass_{std::move(pass)},
      transfers_{std::move(transfers)}, transfer_{std::make_unique<TransferTable>()} {}

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

hal::Result<> RayCastPicture::update(std::uint64_t upload, const ViewState& view, RayMode mode,
                                     const DrawQuality& quality, const Rect& rect) {
  const VolumePictureKey key = volume_picture_key(view, quality, upload, rect);
  if (drawn_ == key && drawn_mode_ == mode)
    return {};
  const bool transfer_changed =
      !drawn_ || drawn_->window_offset_db != key.window_offset_db ||
      drawn_->window_size_db != key.window_size_db || drawn_->opacity != key.opacity ||
      drawn_->transfer != key.transfer || drawn_->colour_map != key.colour_map;
  drawn_.reset();
  if (key.width != image_.width || key.height != image_.height)
    resize(key.width, key.height);
  if (transfer_changed) {
    make_transfer_table(view, transfers_, *transfer_);
    caster_.set_transfer(*transfer_);
  }
  const glm::vec3 extents = caster_.empty() ? glm::vec3{0} : box_extents_mm(caster_.geometry());
  const double aspect = static_cast<double>(rect.width) / rect.height;
  RaySettings settings;
  settings.mode = mode;
  settings.step_mm =
      std::max({extents.x, extents.y, extents.z}) / static_cast<float>(quality.steps);
  settings.aspect = aspect;
  if (auto ok =
          caster_.draw(make_camera(view, extents, static_cast<float>(aspect)), settings, image_);
      !ok)
    return ok;
  if (auto ok = upload_image(); !ok)
    return ok;
  drawn_ = key;
  drawn_mode_ = mode;
  return {};
}

void RayCastPicture::composite(const Rect& rect, int target_height) const {
  pass_.blend(texture_, rect, target_height);
}

} // namespace octascope::ui
