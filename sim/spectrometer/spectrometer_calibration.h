// Writes the calibration of a simulated spectrometer to a file.
#pragma once

#include <filesystem>

#include "hal/result.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/spectrometer/spectrometer.h"

namespace octascope::sim {

// Writes `file` (TOML) and, beside it, the true curves in full precision: <stem>_k_linear.txt and
// <stem>_dispersion_rad.txt. Spacings are the plan's. Existing files are replaced.
// ErrorCode::system if a file cannot be written, with its path and the system's message.
hal::Result<> write_calibration(const Spectrometer& spectrometer, const pipeline::ScanPlan& plan,
                                const std::filesystem::path& file);

} // namespace octascope::sim
