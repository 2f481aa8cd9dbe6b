// What VolumePainter has of the processor's rays: their copy of the volume.
#include <utility>

#include "ui/scene/volume_painter.h"

namespace octascope::ui {

// Leaves nothing where the ray caster knows no instruction set of this processor.
void VolumePainter::make_caster() {
  caster_wanted_ = true;
  if (auto made = RayCaster::create(team_))
    caster_.emplace(std::move(*made));
}

void VolumePainter::want_processor() {
  if (!caster_wanted_)
    make_caster();
}

// Drawn weaker it would be another one, which nobody knows before all of it is there.
void VolumePainter::bring_ahead(const pipeline::Volume& coming, std::uint64_t number, int finished,
                                const pipeline::Volume& shown) {
  if (!caster_shows_ || weakened_shows_)
    return;
  const bool with_flow = flow_shows_ && coming.has_flow() && !coming.flow_marks.empty();
  if (coming_.bring(coming, number, finished, with_flow) || with_flow != flow_shows_)
    return;
  const FlowVoxels flow{shown.flow, &flow_marks_};
  coming_.make_room(shown, occupancy_, with_flow ? &flow : nullptr, team_);
}

bool VolumePainter::copy_rest_for_rays(const pipeline::Volume& volume, int brought) {
  coming_.give(*caster_);
  prepare_b_scans(volume, {0, brought});
  const pipeline::BScanRange rest{brought, volume.geometry.b_scans};
  return brought == rest.to || renew_for_rays(volume, {&rest, 1}).has_value();
}

void VolumePainter::copy_for_rays(const pipeline::Volume& volume) {
  if (const int brought = weakened_shows_ ? 0 : coming_.has_of(volume, flow_shows_);
      caster_shows_ && brought > 0) {
    caster_shows_ = copy_rest_for_rays(volume, brought);
    return;
  }
  const FlowVoxels flow{volume.flow, &flow_marks_};
  const auto prepare = [this, &volume](int b) { prepare_b_scan(volume, b); };
  caster_shows_ = caster_ && caster_->show(weakened_shows_ ? weakened_ : volume, occupancy_,
                                           prepare, flow_shows_ ? &flow : nullptr);
  if (!caster_shows_)
    prepare_b_scans(volume, {0, volume.geometry.b_scans});
}

hal::Result<> VolumePainter::renew_for_rays(const pipeline::Volume& volume,
                                            std::span<const pipeline::BScanRange> changed) {
  const FlowVoxels flow{volume.flow, &flow_marks_};
  const auto prepare = [this, &volume](int b) { prepare_b_scan(volume, b); };
  if (caster_shows_)
    return caster_->renew(weakened_shows_ ? weakened_ : volume, occupancy_, changed, prepare,
                          flow_shows_ ? &flow : nullptr);
  for (const pipeline::BScanRange& range : changed)
    prepare_b_scans(volume, range);
  return {};
}

} // namespace octascope::ui
