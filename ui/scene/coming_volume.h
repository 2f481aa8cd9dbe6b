// The volume that is being scanned, in a ray caster of its own: what of it is finished is copied while the
// rest comes, so that little is left to copy when somebody waits for its picture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "pipeline/threads/work_team.h"
#include "pipeline/volume/volume.h"
#include "ui/ray_caster/ray_caster.h"

namespace octascope::ui {

// Threads: as the ray caster. Allocates when the shape changes.
class ComingVolume {
public:
  // Copies of the first `finished` B-scans of that volume, which stay as they are, those that it lacks; what it
  // had of another volume is forgotten. Reads none of the others. `number`: what will be its
  // VolumeMetadata::index. `with_flow`: it has flow and its marks. Returns false where there is no room for
  // one of that shape.
  bool bring(const pipeline::Volume& coming, std::uint64_t number, int finished, bool with_flow);

  // Makes room for volumes of that one's shape, which must be whole.
  void make_room(const pipeline::Volume& like, const pipeline::Occupancy& occupancy,
                 const FlowVoxels* flow, const std::shared_ptr<WorkTeam>& team);

  // How many of that volume's first B-scans it has, with their flow or without; 0 of another one, and where
  // the one is there and the other is asked for.
  int has_of(const pipeline::Volume& volume, bool with_flow) const;

  // Exchanges the ray caster for that one, which lacks the other B-scans of the volume.
  void give(RayCaster& caster);

private:
  std::optional<RayCaster> caster_;
  const pipeline::Volume* volume_ = nullptr; // is compared with others alone
  std::uint64_t number_ = 0;
  int brought_ = 0; // of its B-scans, from the first one
};

} // namespace octascope::ui
