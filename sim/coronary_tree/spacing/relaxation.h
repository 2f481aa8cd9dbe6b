// Moves the nodes of a tree so that vessels keep clear of each other and bend gently.
//
// In each round, two segments that run through each other and are not near along the tree move apart,
// perpendicular to both, the thinner one further (position-based dynamics: Müller, Heidelberger,
// Hennix, Ratcliff, J Vis Commun Image R 18, 2007). A node where a vessel bends by more than
// 15 degrees, on its way to its widest daughter, moves towards the line between its neighbours. No
// segment becomes much shorter than half of what it was.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/heart/vector3.h"

namespace octascope::sim {

struct Relaxation {
  std::size_t rounds = 1;
  std::size_t unbending_rounds = 1; // the first ones; the others only move vessels apart
  std::size_t threads = 1;          // including the caller's
  // In a round no node moves further than half its segment's first length and so many of its radii.
  double farthest_radii = std::numeric_limits<double>::infinity();
};

// `still`: for each node whether it keeps its place, as roots always do. `hold` gives the place near
// a place at which a vessel of that order may be; it is called from several threads at once. The
// same bits for any number of threads. `progress` is called on this thread with numbers up to 1; may be
// empty.
void relax(pipeline::VesselTree& tree, const std::vector<bool>& still, const Relaxation& how,
           const std::function<Vector3(Vector3 place, std::size_t order)>& hold,
           const std::function<void(double)>& progress);

} // namespace octascope::sim
