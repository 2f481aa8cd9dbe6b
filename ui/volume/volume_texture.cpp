#include "ui/volume/volume_texture.h"

#include <algorithm>

namespace octascope::ui {

namespace {

hal::Result<> check(const pipeline::Volume& volume) {
  const pipeline::VolumeGeometry& g = volume.geometry;
  if (g.depths < 1 || g.a_scans < 1 || g.b_scans < 1 || volume.levels.size() != g.voxels() ||
      volume.b_scan_states.size() != static_cast<std::size_t>(g.b_scans))
    return hal::fail(hal::ErrorCode::bad_data,
                     "volume display: found {} levels and {} B-scan states, expected those of {} "
                     "depths x {} A-scans x {} B-scans",
                     volume.levels.size(), volume.b_scan_states.size(), g.depths, g.a_scans,
                     g.b_scans);
  return VolumeTexture::check_size(g);
}

} // namespace

hal::Result<> VolumeTexture::check_size(const pipeline::VolumeGeometry& geometry) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
  if (std::max({geometry.depths, geometry.a_scans, geometry.b_scans}) > largest)
    return hal::fail(hal::ErrorCode::unsupported,
                     "volume display: found {} depths x {} A-scans x {} B-scans, expected at most "
                     "{} along each axis on this GPU; lower [scan] samples, a_scans or b_scans",
                     geometry.depths, geometry.a_scans, geometry.b_scans, largest);
  return {};
}

void VolumeTexture::allocate(const pipeline::VolumeGeometry& geometry) {
  for (gl::Texture& texture : textures_) {
    texture = gl::Texture::make();
    glBindTexture(GL_TEXTURE_3D, texture.name());
    glTexStorage3D(GL_TEXTURE_3D, 1, GL_R8, geometry.depths, geometry.a_scans, geometry.b_scans);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    // The same at the border as clamping. Mesa's software rasteriser filters textures of 8 bits
    // that are clamped or repeated along all axes to whole levels, which leaves steps of narrow
    // windows; any other way of wrapping it filters in floating point, in the same time.
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_S, GL_MIRRORED_REPEAT);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
  }
  uploader_ = gl::PixelUploader::create(geometry.voxels());
}

// Into the texture in the back.
hal::Result<> VolumeTexture::write(const pipeline::Volume& volume,
                                   const pipeline::BScanRange& range) {
  const std::size_t size = geometry_.b_scan_voxels();
  HAL_TRY(const void* const pixels, uploader_.stage(std::span{volume.levels}.subspan(
                                        static_cast<std::size_t>(range.from) * size,
                                        static_cast<std::size_t>(range.to - range.from) * size)));
  glBindTexture(GL_TEXTURE_3D, textures_[1 - front_].name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, range.from, geometry_.depths, geometry_.a_scans,
                  range.to - range.from, GL_RED, GL_UNSIGNED_BYTE, pixels);
  gl::PixelUploader::unbind();
  return {};
}

hal::Result<> VolumeTexture::upload(const pipeline::Volume& volume) {
  HAL_CHECK(check(volume));
  if (empty() || volume.geometry != geometry_)
    allocate(volume.geometry);
  geometry_ = volume.geometry;
  HAL_CHECK(write(volume, {0, geometry_.b_scans}));
  old_.assign(static_cast<std::size_t>(geometry_.b_scans), static_cast<std::uint8_t>(1U << front_));
  front_ = 1 - front_;
  return {};
}

// What the texture in the back lacks from before is written, too.
hal::Result<> VolumeTexture::renew(const pipeline::Volume& volume,
                                   std::span<const pipeline::BScanRange> changed) {
  if (empty() || volume.geometry != geometry_)
    return upload(volume);
  HAL_CHECK(check(volume));
  for (const pipeline::BScanRange& range : changed)
    std::fill(old_.begin() + range.from, old_.begin() + range.to, std::uint8_t{3});
  const auto back = static_cast<std::uint8_t>(2U >> front_);
  for (int b = 0; b < geometry_.b_scans;) {
    pipeline::BScanRange range{b, b};
    for (; b < geometry_.b_scans && (old_[static_cast<std::size_t>(b)] & back) != 0; ++b)
      old_[static_cast<std::size_t>(b)] &= static_cast<std::uint8_t>(~back);
    range.to = b;
    if (range.from == range.to)
      ++b;
    else
      HAL_CHECK(write(volume, range));
  }
  front_ = 1 - front_;
  return {};
}

} // namespace octascope::ui
