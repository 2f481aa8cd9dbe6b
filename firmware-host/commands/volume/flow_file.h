// What flows in a volume, from a file beside it.
#pragma once

#include <filesystem>

#include "hal/result.h"
#include "pipeline/volume/volume.h"

namespace octascope::firmware_host {

// `file`: NRRD as `reconstruct --flow` writes it. A B-scan of which nothing is told counts as left out.
// Errors: read_nrrd()'s; ErrorCode::bad_data: it holds no flow; ErrorCode::invalid_argument: it is of
// another shape. Then the volume is as it was.
hal::Result<> read_flow_beside(const std::filesystem::path& file, pipeline::Volume& volume);

} // namespace octascope::firmware_host
