// The interface of all ways of drawing a vessel tree.
#pragma once

#include "hal/result.h"
#include "ui/vessels/scene/vessel_scene.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Threads: as gl/objects.h. draw() allocates nothing after the first of a tree and a size.
class VesselMethod {
public:
  virtual ~VesselMethod() = default;

  // Draws into the bound framebuffer and viewport, which must have 8-bit RGBA and at least 24 bits
  // of depth, be cleared (colour 0, depth 1) and be as large as the scene says. The result is
  // opaque colours (alpha 1 where there is a vessel), and depths by the camera's view_projection.
  // Every segment is counted.
  hal::Result<SegmentCounts> draw(const VesselScene& scene) { return do_draw(scene); }

private:
  virtual hal::Result<SegmentCounts> do_draw(const VesselScene& scene) = 0;
};

} // namespace octascope::ui
