#include "ui/volume/volume_techniques.h"

#include <cstddef>

#include "ui/volume/plane_stack.h"
#include "ui/volume/ray_cast_technique.h"
#include "ui/volume/slice_stack.h"

namespace octascope::ui {

namespace {

using Made = hal::Result<std::unique_ptr<VolumeTechnique>>;

template <class Kind> Made owned(hal::Result<Kind> made) {
  if (!made)
    return tl::make_unexpected(made.error());
  return std::make_unique<Kind>(std::move(*made));
}

Made make(Technique technique, WithFlow flow, const TransferSet& transfers,
          const pipeline::ThreadSetup& threads) {
  switch (technique) {
  case Technique::slices: return owned(SliceStack::create(flow));
  case Technique::planes: return owned(PlaneStack::create(flow));
  case Technique::rays: break;
  case Technique::shaded: return owned(RayCastTechnique::create(RayMode::shaded, flow));
  case Technique::maximum: return owned(RayCastTechnique::create(RayMode::maximum, flow));
  case Technique::surface: return SurfaceTechnique::create(transfers, threads);
  }
  return owned(RayCastTechnique::create(RayMode::composite, flow));
}

} // namespace

hal::Result<VolumeTechnique*> VolumeTechniques::get(Technique technique, WithFlow flow) {
  const bool alone = flow == WithFlow::yes && technique != Technique::surface;
  std::unique_ptr<VolumeTechnique>& kept =
      (alone ? made_with_flow_ : made_)[static_cast<std::size_t>(technique)];
  if (!kept) {
    HAL_TRY(auto made, make(technique, flow, transfers_, threads_));
    kept = std::move(made);
  }
  if (technique == Technique::surface && flow == WithFlow::yes)
    HAL_CHECK(surface()->prepare_flow());
  return kept.get();
}

SurfaceTechnique* VolumeTechniques::surface() const {
  return static_cast<SurfaceTechnique*>(made_[static_cast<std::size_t>(Technique::surface)].get());
}

} // namespace octascope::ui
