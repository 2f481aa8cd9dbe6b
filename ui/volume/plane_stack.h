// The view-aligned plane stack: planes perpendicular to the view through the 3D texture.
#pragma once

#include "ui/volume/polygon_stack.h"

namespace octascope::ui {

// As many planes as the step requires, evenly spaced, half a spacing from the borders of the
// volume; source in ui/view/plane_box.h.
//
// Threads: as gl/objects.h. Allocates only when made.
class PlaneStack : public VolumeTechnique {
public:
  static hal::Result<PlaneStack> create();

private:
  explicit PlaneStack(PolygonStack stack) : stack_{std::move(stack)} {}
  void do_draw(const VolumeScene& scene) override;

  PolygonStack stack_;
};

} // namespace octascope::ui
