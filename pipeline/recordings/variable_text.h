// A text of variable length in an attribute.
//
// HDF5 takes memory for whatever length the file says, and version 1.10 copies a longer text over the
// end of it. So HDF5 is asked for no more than where the text lies, and it is read here.
#pragma once

#include <cstddef>
#include <string>

#include "hal/result.h"
#include "pipeline/recordings/hdf5.h"

namespace octascope::pipeline {

// ErrorCode::bad_data: it has more than `most_bytes`, or the file is damaged there.
hal::Result<std::string> read_variable_text(hid_t attribute, std::size_t most_bytes);

} // namespace octascope::pipeline
