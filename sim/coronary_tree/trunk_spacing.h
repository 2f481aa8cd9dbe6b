// Makes the large vessels of the three arteries keep clear of each other, once all are grown.
#pragma once

#include <array>

#include "sim/coronary_tree/trunk_growth.h"

namespace octascope::sim {

// Where a vessel of that order may run: orders 8 and lower in muscle, the others not far outside.
Vector3 held_in_place(Vector3 place, std::size_t order);

// Moves the nodes, and with them the beginnings of elements. The same for any number of threads.
void space_trunks(const std::array<TrunkPlan, 3>& plans, std::array<GrownTrunk, 3>& grown,
                  std::size_t threads);

} // namespace octascope::sim
