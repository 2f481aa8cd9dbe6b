// From clusters back to a tree.
#pragma once

#include <functional>

#include "hal/result.h"
#include "pipeline/vessels/clusters.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// Every segment once, joined as they were; places and radii within the file's stated error
// (VesselFacts::error). Nodes are in an order of their own, parents first. A root, which ends no
// segment, gets the branch and the highest order of those that leave it. Not there: roots without a
// child. ErrorCode::bad_data where segments form a ring.
//
// `clusters` must be what build_clusters() made or read_cluster_bytes() checked, with sources.
// `progress` is called on this thread, 0 to 1; may be empty.
hal::Result<VesselTree> unpack_tree(const VesselClusters& clusters,
                                    const std::function<void(double)>& progress = {});

} // namespace octascope::pipeline
