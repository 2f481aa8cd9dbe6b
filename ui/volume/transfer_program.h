// Shaders that apply the transfer function to levels.
#pragma once

#include <string_view>

#include "hal/result.h"
#include "ui/gl/program.h"
#include "ui/transfer/transfer_texture.h"
#include "ui/volume/flow_scene.h"

namespace octascope::ui {

// Sets what ui/shaders/depth_tint.glsl reads.
void set_depth_tint(const gl::Program& program, const DepthColours& depths);

// Sets what ui/shaders/flow_look.glsl reads, and the texture of flow as u_flow, texture unit 6.
void set_flow(const gl::Program& program, const FlowScene& flow);

struct VolumeShader {
  std::string_view name;
  std::string_view vertex;
  std::string_view fragment;     // without ui/shaders/transfer.glsl, which precedes it
  std::string_view defines = {}; // whole lines, for the fragment shader
  WithFlow flow = WithFlow::no;
};

// One program in three variants from the same source: one computes a display window, another uses a
// look-up table, the third gives that table's greys the hue of their depth.
//
// Threads: as gl/objects.h.
class TransferProgram {
public:
  static hal::Result<TransferProgram> create(const VolumeShader& shader);

  // Makes the variant for `transfer` current and sets its transfer function; `flow` of a shader with
  // it, else null. u_levels is texture unit 0; units 2, 5 and from 7 on are free.
  const gl::Program& use(const TransferTexture& transfer, const FlowScene* flow) const;

private:
  const gl::Program& variant(const TransferTexture& transfer) const;
  TransferProgram(gl::Program window, gl::Program table, gl::Program by_depth, gl::Texture dither)
      : window_{std::move(window)}, table_{std::move(table)}, by_depth_{std::move(by_depth)},
        dither_{std::move(dither)} {}
  gl::Program window_;
  gl::Program table_;
  gl::Program by_depth_;
  gl::Texture dither_;
};

} // namespace octascope::ui
