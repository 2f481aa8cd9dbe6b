// The calibration in a file of raw spectra: its curves as numbers, so that nothing else is needed
// to make the same levels again.
#pragma once

#include "hal/result.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/recordings/hdf5/hdf5.h"

namespace octascope::pipeline {

// Makes the group. What a curve was made from (SourceShaping) is left out: the curve is there.
bool write_raw_calibration(hid_t file, const Calibration& calibration);

// Checked as Calibration::validate() does. ErrorCode::bad_data with found and expected.
hal::Result<Calibration> read_raw_calibration(hid_t file, int samples);

} // namespace octascope::pipeline
