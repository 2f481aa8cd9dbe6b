#include "ui/scene/coming_volume.h"

#include <utility>

namespace octascope::ui {

bool ComingVolume::bring(const pipeline::Volume& coming, std::uint64_t number, int finished,
                         bool with_flow) {
  if (!caster_ || caster_->empty() || caster_->geometry() != coming.geometry ||
      caster_->has_flow() != with_flow)
    return false;
  if (volume_ != &coming || number_ != number) {
    volume_ = &coming;
    number_ = number;
    brought_ = 0;
  }
  // The flow at a B-scan is copied with what is marked in the next one.
  const bool lacks_next = with_flow && finished < coming.geometry.b_scans;
  const pipeline::BScanRange range{brought_, lacks_next ? finished - 1 : finished};
  if (range.to <= range.from)
    return true;
  const FlowVoxels flow{coming.flow, &coming.flow_marks};
  if (caster_->renew(coming, coming.occupancy, {&range, 1}, {}, with_flow ? &flow : nullptr))
    brought_ = range.to;
  return true;
}

void ComingVolume::make_room(const pipeline::Volume& like, const pipeline::Occupancy& occupancy,
                             const FlowVoxels* flow, const std::shared_ptr<WorkTeam>& team) {
  volume_ = nullptr;
  if (!caster_)
    if (auto made = RayCaster::create(team))
      caster_.emplace(std::move(*made));
  if (caster_ && !caster_->show(like, occupancy, {}, flow))
    caster_.reset();
}

int ComingVolume::has_of(const pipeline::Volume& volume, bool with_flow) const {
  const bool is_it = volume_ == &volume && number_ == volume.metadata.index;
  return is_it && caster_->has_flow() == with_flow ? brought_ : 0;
}

void ComingVolume::give(RayCaster& caster) {
  std::swap(*caster_, caster);
  volume_ = nullptr;
}

} // namespace octascope::ui
