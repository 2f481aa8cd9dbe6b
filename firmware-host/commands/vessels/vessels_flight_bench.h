// The part of octascope vessels bench that flies through the tree
// (ui/vessels/view/vessel_flight.h).
#pragma once

#include <functional>
#include <string_view>

#include "firmware-host/commands/vessels/vessels_bench_painter.h"
#include "hal/result.h"
#include "ui/vessels/scene/vessel_method.h"

namespace octascope::firmware_host {

// Differences are means over the picture, of 255; a step is half a pixel.
struct VesselsFlightReport {
  int places = 0; // at each, two frames a step apart
  double length_mm = 0;
  // For the hybrid's frames.
  double ms_p50 = 0;
  double ms_p95 = 0;
  double worst_difference = 0; // from quads
  double worst_step = 0;       // from frame to frame
  double worst_quads_step = 0; // the same of quads
  double worst_beyond = 0;     // largest excess of a hybrid's step over the same step of quads
};

// `progress` is called with a line for each place; may be empty.
hal::Result<VesselsFlightReport>
bench_flight(VesselsBenchPainter& painter, ui::VesselMethod& hybrid, ui::VesselMethod& quads,
             int places, const std::function<void(std::string_view)>& progress);

} // namespace octascope::firmware_host
