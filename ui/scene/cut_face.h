// The faces of a cut volume: the B-scan, or parts of both crossed ones, in their place in the volume.
#pragma once

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/layout/layout.h"
#include "ui/view/cut.h"
#include "ui/volume/transfer_program.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates when it is made, never afterwards.
class CutFace {
public:
  static hal::Result<CutFace> create(WithFlow flow);

  // Blends them over the volume's picture in `rect` of the bound framebuffer; all that a cut leaves
  // lies behind it. In the levels as they came: nothing is drawn weaker here. `flow`: null if it was
  // made without.
  void composite(const VolumeTexture& volume, const TransferTexture& transfer,
                 const FlowScene* flow, const Camera& camera, const CutAway& away, const Rect& rect,
                 int target_height) const;

private:
  void draw_face(const gl::Program& program, const CutAway& away, int across) const;
  explicit CutFace(TransferProgram program)
      : program_{std::move(program)}, vertex_array_{gl::VertexArray::make()} {}

  TransferProgram program_;
  gl::VertexArray vertex_array_; // empty: vertices are computed from their index
};

} // namespace octascope::ui
