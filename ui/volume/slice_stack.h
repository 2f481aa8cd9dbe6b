// The object-aligned stack: the volume's own slices along the axis most parallel to the view.
#pragma once

#include "ui/volume/polygon_stack.h"

namespace octascope::ui {

// The oldest technique: each slice is a rectangle with its own picture. Nothing is interpolated
// between slices, so the spacing of the B-scans shows on the slow axis. When the view turns past
// 45°, the stack changes its axis.
//
// Source: the stacks of 2D textures that the OCT paper describes before its plane stack.
//
// Threads: as gl/objects.h. Allocates when it is made, never afterwards.
class SliceStack : public VolumeTechnique {
public:
  static hal::Result<SliceStack> create(WithFlow flow = WithFlow::no);

private:
  explicit SliceStack(PolygonStack stack) : stack_{std::move(stack)} {}
  void do_draw(const VolumeScene& scene) override;

  PolygonStack stack_;
};

} // namespace octascope::ui
