// Generates the coronary arteries of a pig's heart at random, from statistics measured on casts.
//
// Orders, connectivity, diameters and lengths follow sim/coronary_tree/morphometry.h; the shape of
// the heart is in sim/coronary_tree/heart/heart_wall.h. Layout after Kaimovitz, Lanir, Kassab (Ann
// Biomed Eng 33, 2005): orders 11 to 9 on the heart's surface, 8 to 5 through its wall, 4 to 0
// filling it. To fill the space, the muscle is divided from the trunk to the twigs, and each vessel
// heads for the middle of its own piece. Then vessels are moved out of each other and bent
// gently (sim/coronary_tree/spacing/relaxation.h), the large ones first.
//
// The same seed and number of segments give the same bits, for any number of threads and on every
// machine with IEEE 754 double and single precision. For this, the arithmetic uses only sums,
// products, quotients and square roots without contraction, random numbers are hashes, and nothing
// depends on an order that the standard library leaves open. The large vessels (orders 11 to 5)
// depend only on the seed, for every number of segments that includes them.
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
  // Exactly the requested number of segments. There are three more nodes than segments: the roots
  // of RCA, LAD and LCX. Depth first: parents before children; neighbours in space are mostly
  // neighbours in the file. In the frame of heart_wall.h.
  pipeline::VesselTree tree;
  LowOrders low;                // what was omitted or added in orders 4 to 0
  std::size_t lowest_order = 0; // the lowest one present, perhaps only in part
};

// `progress` is called on this thread with numbers from 0 to 1; may be empty. Fails if the number
// of segments or threads is out of range.
hal::Result<CoronaryTree> generate_coronary_tree(const CoronaryTreeRequest& request,
                                                 const std::function<void(double)>& progress = {});

} // namespace octascope::sim
