// A loaded tree with its place in the volume, if known.
#pragma once

#include <cstddef>
#include <optional>

#include "firmware-host/vessels/vessel_source.h"
#include "ui/view/vessel_placement.h"

namespace octascope::firmware_host {

// Borrows from `vessels`.
inline ui::PlacedVessels
place_vessels(const LoadedVessels& vessels,
              const std::optional<pipeline::RigidTransform>& volume_from_tree) {
  const pipeline::VesselFacts& facts = vessels.facts();
  ui::PlacedVessels placed{vessels.clusters(), {}, volume_from_tree};
  for (std::size_t axis = 0; axis < 3; ++axis)
    placed.centre_mm[axis] = (double{facts.lower_mm[axis]} + double{facts.upper_mm[axis]}) / 2;
  return placed;
}

} // namespace octascope::firmware_host
