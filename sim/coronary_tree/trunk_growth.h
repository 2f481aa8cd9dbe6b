// The courses of the large vessels (orders 11 to 5), and the piece of muscle that each feeds.
//
// Each element has a region of muscle as large as its weight. At each fork the region is divided
// between the side branch and the vessel itself, which heads for the middle of the remainder. So
// the muscle is divided down to the smallest vessels without gap or overlap. Orders 11 to 9 run
// upon the heart (inside the septum, which has no outside), the others through the wall.
#pragma once

#include <span>
#include <vector>

#include "sim/coronary_tree/heart/main_courses.h"
#include "sim/coronary_tree/heart/region.h"
#include "sim/coronary_tree/trunk_plan.h"

namespace octascope::sim {

struct TrunkNode {
  Vector3 place; // the end of a segment
  double diameter_um;
};

// Beside each planned element. Those of low orders have no nodes.
struct GrownElement {
  std::size_t first_node = 0; // one per segment
  std::size_t first_cell = 0; // its region
  std::size_t cells = 0;
  Vector3 start;
  Vector3 direction;
  double mother_um = 0;
};

struct GrownTrunk {
  Vector3 root;
  double root_um = 0;
  std::vector<TrunkNode> nodes;
  std::vector<GrownElement> elements;
};

// Reorders the cells so that each element's are contiguous. May also change the joints from which
// the artery's own daughters spring, to suit the muscle that they feed.
GrownTrunk grow_trunk(const BranchMorphometry& branch, TrunkPlan& plan, const Course& course,
                      Region cells, std::uint64_t key);

} // namespace octascope::sim
