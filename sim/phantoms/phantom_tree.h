// A phantom's vessels as a tree, and its place in the volume of the simulated camera.
#pragma once

#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/vessels/tree.h"
#include "sim/phantoms/phantom.h"

namespace octascope::sim {

struct PhantomTree {
  pipeline::VesselTree tree;                 // in the phantom's frame; several roots
  pipeline::RigidTransform volume_from_tree; // exact
};

// Only of vessels within the field of the phantom's suggested plan.
PhantomTree phantom_tree(const Phantom& phantom);

} // namespace octascope::sim
