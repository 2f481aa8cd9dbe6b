// What flows in a scene.
#pragma once

#include "pipeline/volume/occupancy.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

// Whether what flows is drawn, too.
enum class WithFlow : bool { no, yes };

// Borrowed for one draw(); what it looks like: ui/transfer/flow_look.h.
struct FlowScene {
  const VolumeTexture& texture;         // of Voxels::flow; only what GL draws reads it
  const pipeline::Occupancy& occupancy; // of the counts of flow
  float opacity;                        // of what flows for certain, over one reference step
};

} // namespace octascope::ui
