// The view-aligned plane stack: planes perpendicular to the view through the 3D texture.
#pragma once

#include "ui/volume/polygon_stack.h"

namespace octascope::ui {

// As many planes as the step asks for, spread evenly, half of their spacing from the borders of the
// volume: ui/view/plane_box.h has the source.
//
// Threads: as gl/objects.h. Allocates when it is made, never afterwards.
class PlaneStack : public VolumeTechnique {
public:
  static hal::Result<PlaneStack> create();

private:
  explicit PlaneStack(PolygonStack stack) : stack_{std::move(stack)} {}
  void do_draw(const VolumeScene& scene) override;

  PolygonStack stack_;
};

} // namespace octascope::ui
