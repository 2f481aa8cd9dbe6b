// The ways of drawing the volume by GL, each made when it is first chosen.
#pragma once

#include <array>
#include <memory>
#include <utility>

#include "hal/result.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view/technique.h"
#include "ui/volume/surface_technique.h"
#include "ui/volume/volume_technique.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class VolumeTechniques {
public:
  // `threads` is called on the surface's thread.
  explicit VolumeTechniques(TransferSet transfers, pipeline::ThreadSetup threads = {})
      : transfers_{std::move(transfers)}, threads_{std::move(threads)} {}

  // Owned by this. ErrorCode::unsupported: this GL cannot compile its shaders.
  hal::Result<VolumeTechnique*> get(Technique technique);
  // For Technique::surface, which draws its own meshes; null before it was first requested.
  SurfaceTechnique* surface() const;

private:
  TransferSet transfers_;
  pipeline::ThreadSetup threads_;
  std::array<std::unique_ptr<VolumeTechnique>, all_techniques.size()> made_;
};

} // namespace octascope::ui
