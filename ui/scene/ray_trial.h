// Measures whether the processor or the shader casts rays faster on this machine.
#pragma once

#include "hal/clock.h"
#include "hal/result.h"
#include "ui/view/draw_quality.h"

namespace octascope::ui {

struct RayTrial {
  // The least time of a few small pictures: others were held up by something else.
  hal::Duration shader = hal::Duration::max();
  hal::Duration processor = hal::Duration::max();

  RayBackend faster() const {
    return processor < shader ? RayBackend::processor : RayBackend::shader;
  }
};

// Draws a synthetic volume with both, into its own textures; takes about a tenth of a second with
// software GL. Uses the current thread and context. ErrorCode::unsupported: one of the two cannot
// draw here, so there is nothing to choose.
hal::Result<RayTrial> try_ray_backends(const hal::Clock& clock);

} // namespace octascope::ui
