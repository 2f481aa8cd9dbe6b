// Vessel trees to VTK XML poly data (.vtp), ascii, for programs that draw or measure centrelines.
//
// Format: VTK File Formats (docs.vtk.org). Each vessel, from a root or a branch point to the next one or
// to a tip, is a polyline; vessels share the points where they meet. Lengths in millimetres. Every
// point has its radius, in the array "Radius". Branches and orders are not kept: read_vtp() computes
// orders, and joins vessels that run into each other within a quarter of a radius.
#pragma once

#include <filesystem>

#include "hal/result.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// Atomic (atomic_file.h). ErrorCode::invalid_argument as check_tree_to_write(), and for a tree without
// any segment.
hal::Result<> write_vtp(const std::filesystem::path& file, const VesselTree& tree);

} // namespace octascope::pipeline
