// How a volume is drawn, for tests that compare pictures of several ways.
#pragma once

#include <ostream>

#include "ui/view/choice_value.h"
#include "ui/view/draw_quality.h"
#include "ui/view/technique.h"

namespace octascope::tests {

struct DrawingWay {
  ui::Technique technique;
  ui::DrawQuality quality;
  float see_through_db;
  bool flow = false;
  float vessel_opacity = 0; // 0: none are shown

  // Also in the test's name.
  friend void PrintTo(const DrawingWay& way, std::ostream* out) {
    *out << ui::technique_values[static_cast<std::size_t>(way.technique)].name << ", "
         << way.quality.resolution << ", " << way.quality.steps << " steps, "
         << (way.quality.rays == ui::RayBackend::shader ? "shader" : "processor") << ", "
         << way.see_through_db << " dB" << (way.flow ? ", flow" : "");
    if (way.vessel_opacity > 0)
      *out << ", vessels " << way.vessel_opacity;
  }
};

} // namespace octascope::tests
