// Shaders that look levels up in the transfer function.
#pragma once

#include <string_view>

#include "hal/result.h"
#include "ui/gl/program.h"
#include "ui/transfer/transfer_texture.h"

namespace octascope::ui {

struct VolumeShader {
  std::string_view name;
  std::string_view vertex;
  std::string_view fragment;     // what follows ui/shaders/transfer.glsl
  std::string_view defines = {}; // whole lines, for the fragment shader
};

// One program in two variants of the same source: one computes a display window, the other looks
// everything up in a table.
//
// Threads: as gl/objects.h.
class TransferProgram {
public:
  static hal::Result<TransferProgram> create(const VolumeShader& shader);

  // Makes the variant for `transfer` current, with its transfer function set; u_levels is texture
  // unit 0, and units from 2 on are free.
  const gl::Program& use(const TransferTexture& transfer) const;

private:
  TransferProgram(gl::Program window, gl::Program table)
      : window_{std::move(window)}, table_{std::move(table)} {}
  gl::Program window_;
  gl::Program table_;
};

} // namespace octascope::ui
