// The calibration that fits a simulated spectrometer, as a file.
#pragma once

#include <filesystem>

#include "hal/result.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/spectrometer/spectrometer.h"

namespace octascope::sim {

// Writes `file` (TOML) and, beside it, the curves that went in, true to the last digit:
// <stem>_k_linear.txt and <stem>_dispersion_rad.txt. Spacings are the plan's. Existing files are
// replaced. ErrorCode::system when a file cannot be written, with its path and the system's words.
hal::Result<> write_calibration(const Spectrometer& spectrometer, const pipeline::ScanPlan& plan,
                                const std::filesystem::path& file);

} // namespace octascope::sim
