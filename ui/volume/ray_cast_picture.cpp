#include "ui/volume/ray_cast_picture.h"

#include <algorithm>
#include <utility>

#include "embedded_shaders.h"

#include "ui/dither/soften.h"
#include "ui/gl/picture_texture.h"
#include "ui/gl/scissor.h"
#include "ui/ray_caster/mask_merge.h"

namespace octascope::ui {

namespace {

std::size_t tile_count(int pixels) {
  return static_cast<std::size_t>((pixels + tile_size - 1) / tile_size);
}

// Whether `held` is the same picture of the volume before some B-scans were renewed.
bool holds_before(const std::optional<VolumePictureKey>& held, VolumePictureKey key) {
  --key.upload;
  return held == key;
}

bool any_of(const std::uint32_t* from, const std::uint32_t* to) {
  std::uint32_t all = 0;
  for (; from != to; ++from)
    all |= *from;
  return all != 0;
}

} // namespace

hal::Result<RayCastPicture> RayCastPicture::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("ray_image", shaders::ray_image_frag));
  return RayCastPicture{std::move(pass)};
}

// With room for full quality at once: a finer picture later asks for no memory.
void RayCastPicture::fit(RayImage& image, int width, int height) const {
  image.make_room(most_wide_, most_high_);
  image.resize(width, height);
}

hal::Result<> RayCastPicture::resize(int width, int height, const Rect& rect) {
  texture_ = gl::make_picture_texture(GL_RGBA8, width, height);
  GLint has_memory = GL_FALSE;
  glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_IMMUTABLE_FORMAT, &has_memory);
  if (has_memory == GL_FALSE)
    return hal::fail(hal::ErrorCode::system,
                     "volume display: the driver has no texture of {}x{} (GL error 0x{:04x}); "
                     "choose a smaller size",
                     width, height, glGetError());
  most_wide_ = rect.width;
  most_high_ = rect.height;
  fit(image_, width, height);
  const auto tiles = [](int pixels) { return static_cast<std::size_t>(pixels / tile_size + 2); };
  const std::size_t most_tiles = tiles(rect.width) * tiles(rect.height);
  changed_.reserve(most_tiles);
  filled_.reserve(most_tiles);
  was_filled_.reserve(most_tiles);
  filled_.assign(tile_count(width) * tile_count(height), 1); // what stands there now is unknown
  return {};
}

// Straight from memory: where the processor casts rays it is GL, too, and a pixel buffer would be
// one copy more.
void RayCastPicture::upload_image() {
  const RayImage& image = shown();
  const Rect& drawn = renews_ ? image_.renewed : image.drawn;
  if (drawn.empty())
    return;
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, image.width);
  glPixelStorei(GL_UNPACK_SKIP_PIXELS, drawn.x);
  glPixelStorei(GL_UNPACK_SKIP_ROWS, drawn.y);
  glTexSubImage2D(GL_TEXTURE_2D, 0, drawn.x, drawn.y, drawn.width, drawn.height, GL_RGBA,
                  GL_UNSIGNED_BYTE, image.rgba.data());
  glPixelStorei(GL_UNPACK_SKIP_ROWS, 0);
  glPixelStorei(GL_UNPACK_SKIP_PIXELS, 0);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

hal::Result<> RayCastPicture::cast(RayCaster& caster, const VolumeScene& scene, RayMode mode,
                                   const DrawQuality& quality, const VolumePictureKey& key) {
  RaySettings settings;
  settings.mode = mode;
  settings.step_mm = scene.step_mm;
  settings.cut_away = scene.cut_away;
  settings.light = scene.light;
  if (scene.flow != nullptr) {
    settings.flow_opacity = scene.flow->opacity;
    settings.coarse_beside_flow = quality.resolution < 1;
  }
  settings.soften = is_grained(scene.step_mm, scene.volume.geometry());
  const DepthMask* vessels = scene.vessels;
  const bool veiled = vessels != nullptr && vessels->opacity < 1;
  VolumePictureKey alone_key = key;
  alone_key.vessels = 0;
  alone_key.vessel_opacity = 1;
  renews_ = scene.light == nullptr && mode == drawn_mode_ && holds_before(cast_, key) &&
            (!veiled || holds_before(alone_drawn_, alone_key));
  if (renews_)
    settings.changed = scene.changed;
  if (veiled && (alone_drawn_ != alone_key || alone_mode_ != mode)) {
    alone_drawn_.reset();
    if (key.width != alone_.width || key.height != alone_.height)
      fit(alone_, key.width, key.height);
    HAL_CHECK(caster.draw(scene.camera, settings, alone_));
    alone_drawn_ = alone_key;
    alone_mode_ = mode;
  }
  if (vessels != nullptr)
    settings.stops = vessels->image;
  HAL_CHECK(caster.draw(scene.camera, settings, image_));
  has_vessels_ = vessels != nullptr;
  if (has_vessels_)
    merge(*vessels);
  return {};
}

// The rays' own image stays without vessels, so that a part of it can be cast anew.
void RayCastPicture::merge(const DepthMask& vessels) {
  if (merged_.width != image_.width || merged_.height != image_.height)
    fit(merged_, image_.width, image_.height);
  const Rect& drawn = image_.drawn;
  merged_.draw_into(drawn);
  for (int y = drawn.y; y < drawn.bottom(); ++y) {
    const std::ptrdiff_t at = std::ptrdiff_t{y} * image_.width + drawn.x;
    std::copy_n(image_.rgba.begin() + at, drawn.width, merged_.rgba.begin() + at);
  }
  merge_mask(merged_, *vessels.image, vessels.opacity, vessels.opacity < 1 ? &alone_ : nullptr);
}

hal::Result<> RayCastPicture::update(RayCaster& caster, const VolumeScene& scene, RayMode mode,
                                     const DrawQuality& quality, const Rect& rect) {
  const VolumePictureKey key = volume_picture_key(scene, quality, rect);
  changed_.clear();
  if (drawn_ == key && drawn_mode_ == mode)
    return {};
  cast_ = std::exchange(drawn_, std::nullopt);
  if (key.width != image_.width || key.height != image_.height)
    HAL_CHECK(resize(key.width, key.height, rect));
  HAL_CHECK(cast(caster, scene, mode, quality, key));
  upload_image();
  note_changes(caster, renews_);
  drawn_ = key;
  ++drawings_;
  drawn_mode_ = mode;
  return {};
}

// What lies outside of `drawn` in the texture is old; a border of it that is transparent stays out
// of the interpolation with it.
Rect RayCastPicture::visible_in(const Rect& rect) const {
  const Rect& drawn = shown().drawn;
  const auto scaled = [](int texel, int texels, int pixels) {
    return static_cast<int>(std::int64_t{texel} * pixels / texels);
  };
  const auto from = [](int edge) { return edge > 0 ? edge + 1 : 0; };
  const auto to = [](int edge, int most) { return edge < most ? edge - 1 : most; };
  const int left = scaled(from(drawn.x), image_.width, rect.width);
  const int top = scaled(from(drawn.y), image_.height, rect.height);
  return {rect.x + left, rect.y + top,
          scaled(to(drawn.right(), image_.width), image_.width, rect.width) - left,
          scaled(to(drawn.bottom(), image_.height), image_.height, rect.height) - top};
}

void RayCastPicture::find_filled() {
  std::swap(filled_, was_filled_);
  filled_.assign(was_filled_.size(), 0);
  const RayImage& image = shown();
  const std::size_t across = tile_count(image.width);
  const Rect& drawn = image.drawn;
  for (int y = drawn.y; y < drawn.bottom(); ++y) {
    const std::uint32_t* const row =
        image.rgba.data() + static_cast<std::ptrdiff_t>(y) * image.width;
    std::uint8_t* const filled = filled_.data() + static_cast<std::size_t>(y / tile_size) * across;
    for (int x = drawn.x; x < drawn.right(); x = (x / tile_size + 1) * tile_size)
      if (filled[x / tile_size] == 0)
        filled[x / tile_size] =
            any_of(row + x, row + std::min((x / tile_size + 1) * tile_size, drawn.right())) ? 1 : 0;
  }
}

// What was empty and is empty has not changed.
void RayCastPicture::note_changes(const RayCaster& caster, bool renewed) {
  find_filled();
  const auto across = static_cast<int>(tile_count(image_.width));
  for (std::size_t i = 0; i < filled_.size(); ++i) {
    const int at = static_cast<int>(i);
    const Rect tile{at % across * tile_size, at / across * tile_size, tile_size, tile_size};
    if ((filled_[i] | was_filled_[i]) != 0 && (!renewed || caster.may_have_changed(tile)))
      changed_.push_back(tile);
  }
}

// With what is softened and interpolated with it.
Rect RayCastPicture::shown_at(const Rect& texels, const Rect& rect) const {
  constexpr int reach = soften_radius + 2;
  const auto from = [](int texel, int all, int pixels) {
    return static_cast<int>(std::int64_t{std::max(texel - reach, 0)} * pixels / all);
  };
  const auto to = [](int texel, int all, int pixels) {
    return static_cast<int>((std::int64_t{std::min(texel + reach, all)} * pixels + all - 1) / all);
  };
  const int left = from(texels.x, image_.width, rect.width);
  const int top = from(texels.y, image_.height, rect.height);
  return {rect.x + left, rect.y + top, to(texels.right(), image_.width, rect.width) - left,
          to(texels.bottom(), image_.height, rect.height) - top};
}

void RayCastPicture::add_changed(const Rect& rect, Damage& damage) const {
  for (const Rect& texels : changed_)
    damage.add(shown_at(texels, rect));
}

void RayCastPicture::composite(const Rect& rect, int target_height) const {
  const Rect visible = visible_in(rect);
  if (shown().drawn.empty() || visible.empty())
    return;
  // Pixel by pixel there is nothing to interpolate, which costs a software rasteriser a
  // millisecond.
  const bool as_it_is = image_.width == rect.width && image_.height == rect.height;
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  const GLint filter = as_it_is ? GL_NEAREST : GL_LINEAR;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  const gl::Scissor clip{visible, target_height};
  pass_.blend(texture_, rect, target_height);
}

} // namespace octascope::ui
