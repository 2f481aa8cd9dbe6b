// The arteries of a pig's heart, generated at random from measurements of casts.
//
// Orders, connectivity, diameters and lengths follow sim/coronary_tree/morphometry.h; the shape of
// the heart is sim/coronary_tree/heart/heart_wall.h. Layout after Kaimovitz, Lanir, Kassab (Ann
// Biomed Eng 33, 2005): orders 11 to 9 upon the heart, 8 to 5 through its wall, 4 to 0 filling it.
// The space is filled by dividing the muscle from the trunk to the twigs, each vessel heading for
// the middle of its own piece.
//
// The same seed and number of segments give the same bits, whatever the number of threads, on every
// machine with IEEE 754 double and single precision: the only arithmetic is sums, products,
// quotients and square roots, never contracted; random numbers are hashes; and no order is left to
// the standard library. The same seed gives the same large vessels (orders 11 to 5) at every number
// of segments that includes them.
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
  std::size_t threads = 1; // including the caller's
};

struct CoronaryTree {
  // Exactly the segments asked for; three more nodes, the roots of RCA, LAD and LCX. Depth first:
  // parents before children, and neighbours in space mostly close in the file. The frame is
  // heart_wall.h's.
  pipeline::VesselTree tree;
  LowOrders low;                // how orders 4 to 0 were cut or extended
  std::size_t lowest_order = 0; // the lowest present, perhaps in part
};

// `progress` is called on this thread with 0 to 1; may be empty. Fails if the number of segments or
// threads is out of range.
hal::Result<CoronaryTree> generate_coronary_tree(const CoronaryTreeRequest& request,
                                                 const std::function<void(double)>& progress = {});

} // namespace octascope::sim
