#include "ui/panels/flow_sections.h"

#include <algorithm>

#include "ui/gl/picture_texture.h"

namespace octascope::ui {

namespace {

void write(const gl::Texture& texture, int width, int height, const std::uint8_t* counts) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, counts);
}

} // namespace

void FlowSections::note(std::span<const pipeline::BScanRange> changed) {
  a_scan_ = -1;
  const auto has_shown = [this](const pipeline::BScanRange& range) {
    return range.from <= b_scan_ && b_scan_ < range.to;
  };
  if (changed.empty() || std::ranges::any_of(changed, has_shown))
    b_scan_ = -1;
}

void FlowSections::allocate(const pipeline::VolumeGeometry& geometry) {
  geometry_ = geometry;
  fast_ = gl::make_picture_texture(GL_R8, geometry.depths, geometry.a_scans);
  slow_ = gl::make_picture_texture(GL_R8, geometry.depths, geometry.b_scans);
  across_.resize(static_cast<std::size_t>(geometry.depths) *
                 static_cast<std::size_t>(geometry.b_scans));
  b_scan_ = -1;
  a_scan_ = -1;
}

void FlowSections::fetch(const pipeline::Volume& volume, int b_scan, int a_scan) {
  if (!fast_ || volume.geometry != geometry_)
    allocate(volume.geometry);
  if (b_scan_ != b_scan) {
    write(fast_, geometry_.depths, geometry_.a_scans, volume.b_scan_flow(b_scan).data());
    b_scan_ = b_scan;
  }
  if (a_scan_ == a_scan)
    return;
  const auto depths = static_cast<std::size_t>(geometry_.depths);
  auto to = across_.begin();
  for (int b = 0; b < geometry_.b_scans; ++b)
    to = std::ranges::copy(
             volume.b_scan_flow(b).subspan(static_cast<std::size_t>(a_scan) * depths, depths), to)
             .out;
  write(slow_, geometry_.depths, geometry_.b_scans, across_.data());
  a_scan_ = a_scan;
}

} // namespace octascope::ui
