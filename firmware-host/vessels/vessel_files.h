// Writes vessel trees in the format given by the file's name.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "hal/result.h"
#include "pipeline/vessels/tree.h"

namespace octascope::firmware_host {

// ".swc" in whatever letters: SWC in micrometres; ".vtp": VTK's, in millimetres, without orders and
// branches; else our own format. The file appears complete or not at all. `provenance`, for people, says
// where the tree came from; only our format keeps it. Errors as write_swc(), write_vtp() and
// write_cluster_file().
hal::Result<> write_tree(const std::filesystem::path& file, const pipeline::VesselTree& tree,
                         std::string provenance, const std::function<void(double)>& progress = {});

} // namespace octascope::firmware_host
