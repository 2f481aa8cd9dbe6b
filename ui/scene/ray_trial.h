// Measures whether processor or shader casts rays faster on this machine.
#pragma once

#include "hal/clock.h"
#include "hal/result.h"
#include "ui/view/draw_quality.h"

namespace octascope::ui {

struct RayTrial {
  hal::Duration shader{}; // medians of a few small pictures
  hal::Duration processor{};

  RayBackend faster() const {
    return processor < shader ? RayBackend::processor : RayBackend::shader;
  }
};

// Draws a synthetic volume with both, into its own textures: about a tenth of a second with
// software GL. Bound to the thread and context that are current. ErrorCode::unsupported: one of the
// two cannot draw here, so there is no choice.
hal::Result<RayTrial> try_ray_backends(const hal::Clock& clock);

} // namespace octascope::ui
