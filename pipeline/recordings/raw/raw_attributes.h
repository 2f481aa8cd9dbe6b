// What a recording of raw spectra says of itself, as attributes of its file.
#pragma once

#include "hal/result.h"
#include "pipeline/recordings/hdf5/hdf5.h"
#include "pipeline/recordings/raw/raw_recording.h"

namespace octascope::pipeline {

// All of them, and the calibration; how it ends is written as not finished.
bool write_raw_facts(hid_t file, const RawFacts& facts);
bool write_raw_end(hid_t file, const RawEnd& end);

// ErrorCode::bad_data: the message names the attribute, what was found, and what was expected.
hal::Result<RawFacts> read_raw_facts(hid_t file);
hal::Result<RawEnd> read_raw_end(hid_t file);

} // namespace octascope::pipeline
