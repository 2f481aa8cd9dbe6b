// Vessel trees to SWC files that read_swc() reads back exactly: every place, radius, parent, branch
// and order, in the same sequence.
//
// Ids count from 1 in the tree's sequence. Numbers are the shortest decimals that give the same
// float back (decimal.h). Branches are the types 16 to 18, 0 where none is known. Orders, for which
// SWC has no place, are kept in comments that other programs skip (swc_comments.h).
#pragma once

#include <filesystem>

#include "hal/result.h"
#include "pipeline/files/atomic_file.h"
#include "pipeline/vessels/files/tree_reading.h"

namespace octascope::pipeline {

// Micrometres are what SWC files usually have. Atomic (atomic_file.h); ErrorCode::invalid_argument
// for a tree that could not be read back: parents behind their children, numbers that are not
// finite or too large, no node. `progress` as in TreeReadOptions.
hal::Result<> write_swc(const std::filesystem::path& file, const VesselTree& tree,
                        LengthUnit unit = LengthUnit::um,
                        const std::function<void(double)>& progress = {},
                        Readers readers = Readers::as_the_umask_allows);

} // namespace octascope::pipeline
