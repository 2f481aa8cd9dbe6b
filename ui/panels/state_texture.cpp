#include "ui/panels/state_texture.h"

#include <algorithm>

namespace octascope::ui {

void StateTexture::upload(const pipeline::Volume& volume) {
  static_assert(sizeof(pipeline::BScanState) == 1, "uploaded as one byte a B-scan");
  if (volume.geometry.b_scans != b_scans_) {
    b_scans_ = volume.geometry.b_scans;
    texture_ = gl::Texture::make();
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8UI, b_scans_, 1);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  all_good_ = std::ranges::all_of(volume.b_scan_states, [](pipeline::BScanState state) {
    return state == pipeline::BScanState::good;
  });
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, b_scans_, 1, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                  volume.b_scan_states.data());
}

} // namespace octascope::ui
