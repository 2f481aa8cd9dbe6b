#include "ui/panels/state_texture.h"

#include <algorithm>

namespace octascope::ui {

namespace {

std::uint8_t texel_of(const pipeline::Volume& volume, std::size_t b) {
  const pipeline::BScanState state = volume.b_scan_states[b];
  const bool untold = volume.has_flow() && pipeline::has_levels(state) &&
                      volume.flow_states[b] != pipeline::FlowState::told;
  return static_cast<std::uint8_t>(static_cast<unsigned>(state) | (untold ? 16U : 0U));
}

} // namespace

void StateTexture::upload(const pipeline::Volume& volume) {
  const auto b_scans = static_cast<std::size_t>(volume.geometry.b_scans);
  if (states_.size() != b_scans) {
    states_.resize(b_scans);
    texture_ = gl::Texture::make();
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8UI, volume.geometry.b_scans, 1);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  for (std::size_t b = 0; b < b_scans; ++b)
    states_[b] = texel_of(volume, b);
  all_good_ = std::ranges::all_of(states_, [](std::uint8_t state) {
    return state == static_cast<std::uint8_t>(pipeline::BScanState::good);
  });
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, volume.geometry.b_scans, 1, GL_RED_INTEGER,
                  GL_UNSIGNED_BYTE, states_.data());
}

} // namespace octascope::ui
