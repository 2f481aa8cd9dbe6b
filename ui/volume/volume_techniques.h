// The ways of drawing the volume by GL, each made when it is first chosen.
#pragma once

#include <array>
#include <memory>

#include "hal/result.h"
#include "ui/technique.h"
#include "ui/volume/volume_technique.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class VolumeTechniques {
public:
  // Stays ours. Fault::unsupported: this GL cannot compile its shaders.
  hal::Result<VolumeTechnique*> get(Technique technique);

private:
  std::array<std::unique_ptr<VolumeTechnique>, all_techniques.size()> made_;
};

} // namespace octascope::ui
