// The techniques that draw the volume by GL, each created when first used.
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

  // Owned by this object, one for scenes without flow and one for those with it; the surface is one for
  // both. ErrorCode::unsupported: this GL cannot compile the technique's shaders.
  hal::Result<VolumeTechnique*> get(Technique technique, WithFlow flow = WithFlow::no);
  // The technique of Technique::surface, which has meshes of its own; null before its first get().
  SurfaceTechnique* surface() const;

private:
  TransferSet transfers_;
  pipeline::ThreadSetup threads_;
  using Made = std::array<std::unique_ptr<VolumeTechnique>, all_techniques.size()>;
  Made made_;
  Made made_with_flow_; // without the surface
};

} // namespace octascope::ui
