#include "ui/transfer/transfer_texture.h"

#include <cstddef>

namespace octascope::ui {

namespace {

bool same_window(const std::optional<TransferTable::Window>& a,
                 const std::optional<TransferTable::Window>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->ramp.scale == b->ramp.scale && a->ramp.offset == b->ramp.offset &&
                 a->opacity == b->opacity));
}

// Whether that changed anything.
bool set(float& to, float value) {
  const bool changed = to != value;
  to = value;
  return changed;
}

} // namespace

TransferTexture::TransferTexture()
    : texture_{gl::Texture::make()}, texels_(std::size_t{4} * width * height) {
  visible_.margin = 1;
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, width, height);
  // Not filterable everywhere, and incomplete there with any other filter.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void TransferTexture::update(const TransferTable& table) {
  bool changed = version_ == 0 || !same_window(window_, table.window) || depths_ != table.depths;
  for (std::size_t i = 0; i < TransferTable::entries; ++i) {
    float* texel = texels_.data() + 4 * i;
    changed |= set(texel[0], table.colour[i].red);
    changed |= set(texel[1], table.colour[i].green);
    changed |= set(texel[2], table.colour[i].blue);
    changed |= set(texel[3], table.opacity[i]);
  }
  if (!changed)
    return;
  window_ = table.window;
  depths_ = table.depths;
  find_visible_levels(table, visible_);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels_.data());
  ++version_;
}

} // namespace octascope::ui
