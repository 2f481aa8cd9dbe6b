#include "ui/volume/volume_texture.h"

#include <algorithm>

namespace octascope::ui {

std::span<const std::uint8_t> VolumeTexture::voxels(const pipeline::Volume& volume) const {
  return of_ == Voxels::flow ? volume.flow : volume.levels;
}

hal::Result<> VolumeTexture::check(const pipeline::Volume& volume) const {
  const pipeline::VolumeGeometry& g = volume.geometry;
  if (g.depths < 1 || g.a_scans < 1 || g.b_scans < 1 || voxels(volume).size() != g.voxels() ||
      volume.b_scan_states.size() != static_cast<std::size_t>(g.b_scans))
    return hal::fail(hal::ErrorCode::bad_data,
                     "volume display: found {} {} and {} B-scan states, expected those of {} "
                     "depths x {} A-scans x {} B-scans",
                     voxels(volume).size(), of_ == Voxels::flow ? "voxels of flow" : "levels",
                     volume.b_scan_states.size(), g.depths, g.a_scans, g.b_scans);
  return check_size(g);
}

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
  a_scans_.reserve(3 * static_cast<std::size_t>(geometry.depths) *
                   static_cast<std::size_t>(geometry.b_scans));
}

// Into the texture in the back.
hal::Result<> VolumeTexture::write(const pipeline::Volume& volume,
                                   const pipeline::BScanRange& range) {
  const std::size_t size = geometry_.b_scan_voxels();
  HAL_TRY(const void* const pixels, uploader_.stage(voxels(volume).subspan(
                                        static_cast<std::size_t>(range.from) * size,
                                        static_cast<std::size_t>(range.to - range.from) * size)));
  glBindTexture(GL_TEXTURE_3D, textures_[1 - front_].name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, range.from, geometry_.depths, geometry_.a_scans,
                  range.to - range.from, GL_RED, GL_UNSIGNED_BYTE, pixels);
  gl::PixelUploader::unbind();
  return {};
}

// [b][a][depth], as all of a volume.
hal::Result<> VolumeTexture::write_a_scans(const pipeline::Volume& volume,
                                           const pipeline::BScanRange& a_scans) {
  const auto depths = static_cast<std::size_t>(geometry_.depths);
  const std::size_t size = depths * static_cast<std::size_t>(a_scans.to - a_scans.from);
  a_scans_.resize(size * static_cast<std::size_t>(geometry_.b_scans));
  auto to = a_scans_.begin();
  for (int b = 0; b < geometry_.b_scans; ++b)
    to = std::ranges::copy(
             voxels(volume).subspan(static_cast<std::size_t>(b) * geometry_.b_scan_voxels() +
                                        static_cast<std::size_t>(a_scans.from) * depths,
                                    size),
             to)
             .out;
  HAL_TRY(const void* const pixels, uploader_.stage(a_scans_));
  glBindTexture(GL_TEXTURE_3D, textures_[1 - front_].name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage3D(GL_TEXTURE_3D, 0, 0, a_scans.from, 0, geometry_.depths, a_scans.to - a_scans.from,
                  geometry_.b_scans, GL_RED, GL_UNSIGNED_BYTE, pixels);
  gl::PixelUploader::unbind();
  return {};
}

// Into the texture in the back, what it lacks from before, too.
hal::Result<> VolumeTexture::write_lacking(const pipeline::Volume& volume,
                                           const pipeline::BScanRange& within) {
  const auto back = static_cast<std::uint8_t>(2U >> front_);
  for (int b = within.from; b < within.to;) {
    pipeline::BScanRange range{b, b};
    while (b < within.to && (old_[static_cast<std::size_t>(b)] & back) != 0)
      ++b;
    range.to = b;
    if (range.from == range.to) {
      ++b;
      continue;
    }
    HAL_CHECK(write(volume, range));
    for (int written = range.from; written < range.to; ++written)
      old_[static_cast<std::size_t>(written)] &= static_cast<std::uint8_t>(~back);
  }
  return {};
}

// With neighbours, which are interpolated with next to nothing.
pipeline::BScanRange VolumeTexture::b_scans_of(const TextureParts& parts) const {
  if (parts.all)
    return {0, geometry_.b_scans};
  const int middle = std::clamp(parts.b_scan, 0, geometry_.b_scans - 1);
  return {std::max(middle - 1, 0), std::min(middle + 2, geometry_.b_scans)};
}

hal::Result<> VolumeTexture::fill_back(const pipeline::Volume& volume, const TextureParts& parts) {
  HAL_CHECK(write_lacking(volume, b_scans_of(parts)));
  if (!parts.all) {
    const int middle = std::clamp(parts.a_scan, 0, geometry_.a_scans - 1);
    HAL_CHECK(
        write_a_scans(volume, {std::max(middle - 1, 0), std::min(middle + 2, geometry_.a_scans)}));
    a_scan_[1 - front_] = middle;
  }
  front_ = 1 - front_;
  return {};
}

void VolumeTexture::make_old(std::size_t texture, std::span<const pipeline::BScanRange> changed) {
  for (const pipeline::BScanRange& range : changed)
    for (int b = range.from; b < range.to; ++b)
      old_[static_cast<std::size_t>(b)] |= static_cast<std::uint8_t>(1U << texture);
  if (!changed.empty())
    a_scan_[texture] = -1;
}

bool VolumeTexture::lacks_none(std::size_t texture, const pipeline::BScanRange& b_scans) const {
  return std::none_of(old_.begin() + b_scans.from, old_.begin() + b_scans.to,
                      [bit = 1U << texture](std::uint8_t old) { return (old & bit) != 0; });
}

bool VolumeTexture::holds(const TextureParts& parts) const {
  if (empty() || !lacks_none(front_, b_scans_of(parts)))
    return false;
  return parts.all || a_scan_[front_] == std::clamp(parts.a_scan, 0, geometry_.a_scans - 1) ||
         lacks_none(front_, {0, geometry_.b_scans});
}

hal::Result<> VolumeTexture::upload(const pipeline::Volume& volume, const TextureParts& parts) {
  HAL_CHECK(check(volume));
  if (empty() || volume.geometry != geometry_) {
    allocate(volume.geometry);
    geometry_ = volume.geometry;
    old_.assign(static_cast<std::size_t>(geometry_.b_scans), std::uint8_t{3});
    a_scan_ = {-1, -1};
  }
  const pipeline::BScanRange all{0, geometry_.b_scans};
  return renew(volume, {&all, 1}, parts);
}

hal::Result<> VolumeTexture::renew(const pipeline::Volume& volume,
                                   std::span<const pipeline::BScanRange> changed,
                                   const TextureParts& parts) {
  if (empty() || volume.geometry != geometry_)
    return upload(volume, parts);
  HAL_CHECK(check(volume));
  const std::size_t shown = front_; // until another one is written
  make_old(1 - shown, changed);
  HAL_CHECK(fill_back(volume, parts));
  make_old(shown, changed);
  return {};
}

} // namespace octascope::ui
