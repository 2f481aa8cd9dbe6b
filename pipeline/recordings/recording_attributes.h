// What a recording says of itself, as attributes of its file.
#pragma once

#include "hal/result.h"
#include "pipeline/recordings/hdf5/hdf5.h"
#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

// All of them; how it ends is written as not finished.
bool write_facts(hid_t file, const RecordingFacts& facts);
bool write_end(hid_t file, const RecordingEnd& end);

// ErrorCode::bad_data: the message names the attribute, what was found, and what was expected.
hal::Result<RecordingFacts> read_facts(hid_t file);
hal::Result<RecordingEnd> read_end(hid_t file);

} // namespace octascope::pipeline
