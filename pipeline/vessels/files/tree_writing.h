// What the writers of vessel trees share.
#pragma once

#include <cstdint>
#include <filesystem>

#include "hal/result.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// ErrorCode::invalid_argument, with `file`, for a tree that could not be read back: parents behind their
// children, numbers that are not finite or too large, no node or more than `most_nodes`.
hal::Result<> check_tree_to_write(const std::filesystem::path& file, const VesselTree& tree,
                                  std::uint64_t most_nodes);

} // namespace octascope::pipeline
