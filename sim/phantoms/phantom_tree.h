// A phantom's own vessels as a tree, and where it lies in the volume that the twin makes of it.
#pragma once

#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/vessels/tree.h"
#include "sim/phantoms/phantom.h"

namespace octascope::sim {

struct PhantomTree {
  pipeline::VesselTree tree;                 // in the phantom's frame; several roots
  pipeline::RigidTransform volume_from_tree; // exact
};

// Of the vessels that lie in the field of the phantom's suggested plan.
PhantomTree phantom_tree(const Phantom& phantom);

} // namespace octascope::sim
