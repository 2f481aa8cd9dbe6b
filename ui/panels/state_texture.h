// The states of a volume's B-scans as a texture of one texel each, for shaders that mark them: 0
// missing, 1 good, 2 saturated, 3 the seam, and 16 more if there is flow in the volume, but of this
// B-scan it could not be told.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/volume/volume.h"
#include "ui/gl/objects.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates only when the number of B-scans changes.
class StateTexture {
public:
  void upload(const pipeline::Volume& volume);
  GLuint name() const { return texture_.name(); }
  bool all_good() const { return all_good_; } // then no shader need look

private:
  gl::Texture texture_;
  std::vector<std::uint8_t> states_;
  bool all_good_ = false;
};

} // namespace octascope::ui
