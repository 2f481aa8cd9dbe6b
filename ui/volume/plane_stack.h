// The view-aligned plane stack: planes perpendicular to the view through the 3D texture.
#pragma once

#include "ui/volume/polygon_stack.h"

namespace octascope::ui {

// As many planes as the step requires, evenly spaced, the outermost half a spacing from the
// volume's borders; source: see ui/view/plane_box.h.
//
// Threads: as gl/objects.h. Allocates when it is made, never afterwards.
class PlaneStack : public VolumeTechnique {
public:
  static hal::Result<PlaneStack> create(WithFlow flow = WithFlow::no);

private:
  explicit PlaneStack(PolygonStack stack) : stack_{std::move(stack)} {}
  void do_draw(const VolumeScene& scene) override;
  bool do_dithers() const override { return true; }

  PolygonStack stack_;
};

} // namespace octascope::ui
