// The arteries of a pig's heart, drawn by lot from what was measured on casts.
//
// Orders, connectivity, diameters and lengths follow sim/coronary_tree/morphometry.h; the shape of
// the heart is sim/coronary_tree/heart/heart_wall.h. Layout after Kaimovitz, Lanir, Kassab (Ann Biomed
// Eng 33, 2005): orders 11 to 9 upon the heart, 8 to 5 through its wall, 4 to 0 filling it. The
// space is filled by dividing the muscle from the trunk to the twigs, each vessel heading for the
// middle of its own piece.
//
// The same seed and number of segments give the same bits, whatever the number of threads, on every
// machine with IEEE 754 double and single precision: there is no arithmetic but sums, products,
// quotients and square roots, no contraction of them, no random number but hashes, and no order
// that the standard library leaves open. The same seed gives the same large vessels (orders 11 to
// 5) at every number of segments that has them.
#pragma once

#include <cstdint>
#include <functional>

#include "hal/result.h"
#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/low_orders.h"

namespace octascope::sim {

inline constexpr std::uint32_t fewest_coronary_segments = 1000;
inline constexpr std::uint32_t most_coronary_segments = 20'000'000;

struct CoronaryTreeRequest {
  std::uint32_t segments = fewest_coronary_segments;
  std::uint64_t seed = 1;
  std::size_t threads = 1; // the caller's is one of them
};

struct CoronaryTree {
  // Exactly the segments asked for; three roots more nodes, one each for RCA, LAD and LCX. Depth
  // first: parents before children, neighbours in space mostly neighbours in the file. The frame is
  // heart_wall.h's.
  pipeline::VesselTree tree;
  LowOrders low;                // what was cut or added of orders 4 to 0
  std::size_t lowest_order = 0; // that is there, perhaps in part
};

// `progress` is called by this thread with numbers from 0 to 1; may be empty. Fails for a number of
// segments or threads out of range.
hal::Result<CoronaryTree> generate_coronary_tree(const CoronaryTreeRequest& request,
                                                 const std::function<void(double)>& progress = {});

} // namespace octascope::sim
