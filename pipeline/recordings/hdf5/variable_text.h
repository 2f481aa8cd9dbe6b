// A text of variable length in an attribute.
//
// HDF5 allocates whatever length the file states, and version 1.10 writes a longer text beyond the
// end of that memory. So HDF5 is only asked where the text is, and the text is read here.
#pragma once

#include <cstddef>
#include <string>

#include "hal/result.h"
#include "pipeline/recordings/hdf5/hdf5.h"

namespace octascope::pipeline {

// ErrorCode::bad_data: it has more than `most_bytes`, or the file is damaged there.
hal::Result<std::string> read_variable_text(hid_t attribute, std::size_t most_bytes);

} // namespace octascope::pipeline
