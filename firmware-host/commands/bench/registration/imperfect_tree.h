// A vessel tree as tracing would find it in a field: incomplete, a little off, with some that is not
// there.
#pragma once

#include "pipeline/vessels/following/tree_samples.h"
#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/hash_random.h"

namespace octascope::firmware_host {

struct TraceFlaws {
  double least_radius_mm = 0.007; // thinner vessels are not found
  double off_mm = 0.012;  // standard deviation of places, by axis; it wanders along a vessel
  double missing = 0.1;   // share of vessels from fork to fork
  double invented = 0.05; // share of the length, as straight lines anywhere in the field
};

pipeline::VesselTree moved_tree(const pipeline::VesselTree& tree,
                                const pipeline::RigidTransform& motion);

pipeline::VesselTree imperfect_tree(const pipeline::VesselTree& tree,
                                    const pipeline::PointBox& field, const TraceFlaws& flaws,
                                    sim::HashRandom& random);

} // namespace octascope::firmware_host
