// What flows in a scene.
#pragma once

#include "pipeline/volume/flow_marks.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

// Whether what flows is drawn, too.
enum class WithFlow : bool { no, yes };

// Borrowed for one draw(); what it looks like: ui/transfer/flow_look.h.
struct FlowScene {
  const VolumeTexture& texture; // of Voxels::flow; only what GL draws reads it
  const pipeline::FlowMarks& marks;
  float opacity;       // of what flows for certain, over one reference step
  bool before = false; // of the volume that the texture had before
};

} // namespace octascope::ui
