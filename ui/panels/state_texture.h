// The states of a volume's B-scans as a texture of one texel each, for shaders that mark them.
#pragma once

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
  int b_scans_ = 0;
  bool all_good_ = false;
};

} // namespace octascope::ui
