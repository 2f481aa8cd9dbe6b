// The courses of the large vessels (orders 11 to 5), and the piece of muscle that each feeds.
//
// Each element has a region of muscle in proportion to its weight. At each fork the region is
// divided between the daughters and the continuing vessel, which heads for the middle of its
// remaining region. So the muscle is divided down to the smallest vessels without gap or overlap.
// Orders 11 to 9 run on the heart's surface (in the septum, which has no outside, within it), the
// others through the wall.
#pragma once

#include <vector>

#include "sim/coronary_tree/heart/main_courses.h"
#include "sim/coronary_tree/heart/region.h"
#include "sim/coronary_tree/trunk_plan.h"

namespace octascope::sim {

struct TrunkNode {
  Vector3 place; // the end of a segment
  double diameter_um;
};

// One per planned element. Elements of low orders have no nodes.
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

// Reorders the cells so that each element's are contiguous. May also change the joints at which the
// artery's own daughters spring off, to match the muscle that they feed.
GrownTrunk grow_trunk(const BranchMorphometry& branch, TrunkPlan& plan, const Course& course,
                      Region cells, std::uint64_t key);

} // namespace octascope::sim
