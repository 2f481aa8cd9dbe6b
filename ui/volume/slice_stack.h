// The object-aligned stack: the volume's own slices along the axis most parallel to the view.
#pragma once

#include "ui/volume/polygon_stack.h"

namespace octascope::ui {

// The oldest of the techniques: each slice a rectangle with its own picture on it, nothing
// interpolated between slices, so their number along the slow axis is the scan's and shows. When
// the view turns past 45° the stack changes its axis.
//
// Source: the stacks of 2D textures that the OCT paper describes before its plane stack.
//
// Threads: as gl/objects.h. Allocates when it is made, never afterwards.
class SliceStack : public VolumeTechnique {
public:
  static hal::Result<SliceStack> create();

private:
  explicit SliceStack(PolygonStack stack) : stack_{std::move(stack)} {}
  void do_draw(const VolumeScene& scene) override;

  PolygonStack stack_;
};

} // namespace octascope::ui
