// The part of a vessel tree that GL draws while the processor draws the rest.
#pragma once

#include "hal/result.h"
#include "ui/vessels/hybrid/vessel_split.h"
#include "ui/vessels/scene/vessel_scene.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Threads: as gl/objects.h. draw() allocates nothing after the first of a tree and a size.
class GlShare {
public:
  virtual ~GlShare() = default;

  // Submits the segments that `split` gives to GL, under the conditions of VesselMethod, without
  // waiting for them. Counts these alone: drawn and culled.
  hal::Result<SegmentCounts> draw(const VesselScene& scene, const VesselSplit& split) {
    return do_draw(scene, split);
  }

private:
  virtual hal::Result<SegmentCounts> do_draw(const VesselScene& scene,
                                             const VesselSplit& split) = 0;
};

} // namespace octascope::ui
