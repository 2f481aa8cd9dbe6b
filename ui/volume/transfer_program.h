// Shaders that apply the transfer function to levels.
#pragma once

#include <string_view>

#include "hal/result.h"
#include "ui/gl/program.h"
#include "ui/transfer/transfer_texture.h"

namespace octascope::ui {

struct VolumeShader {
  std::string_view name;
  std::string_view vertex;
  std::string_view fragment;     // without ui/shaders/transfer.glsl, which precedes it
  std::string_view defines = {}; // whole lines, for the fragment shader
};

// One program in two variants from the same source: one computes a display window, the other uses a
// look-up table.
//
// Threads: as gl/objects.h.
class TransferProgram {
public:
  static hal::Result<TransferProgram> create(const VolumeShader& shader);

  // Makes the variant for `transfer` current and sets its transfer function. u_levels is texture
  // unit 0; units 2 and from 5 on are free.
  const gl::Program& use(const TransferTexture& transfer) const;

private:
  TransferProgram(gl::Program window, gl::Program table, gl::Texture dither)
      : window_{std::move(window)}, table_{std::move(table)}, dither_{std::move(dither)} {}
  gl::Program window_;
  gl::Program table_;
  gl::Texture dither_;
};

} // namespace octascope::ui
