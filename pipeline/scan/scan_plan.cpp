#include "pipeline/scan/scan_plan.h"

#include <cmath>

namespace octascope::pipeline {

namespace {

using hal::ErrorCode;

hal::Result<> in_range(const char* key, double found, double lowest, double highest) {
  if (std::isfinite(found) && found >= lowest && found <= highest)
    return {};
  return hal::fail(ErrorCode::invalid_argument, "scan plan: {} is {}, expected {} to {}", key,
                   found, lowest, highest);
}

} // namespace

hal::Result<> ScanPlan::validate() const {
  // The upper ends keep every product of counts within 64 bits and every buffer within reason.
  return in_range("samples", samples, 16, 65536)
      .and_then([&] { return in_range("a_scans", a_scans, 1, 65536); })
      .and_then([&] { return in_range("fly_back_lines", fly_back_lines, 0, 65536); })
      .and_then([&] { return in_range("b_scans", b_scans, 1, 65536); })
      .and_then([&] { return in_range("line_rate_hz", line_rate_hz, 1, 1e9); })
      .and_then([&] { return in_range("depth_spacing_um", depth_spacing_um, 1e-3, 1e6); })
      .and_then([&] { return in_range("a_spacing_um", a_spacing_um, 1e-3, 1e6); })
      .and_then([&] { return in_range("b_spacing_um", b_spacing_um, 1e-3, 1e6); })
      .and_then([&] { return in_range("turn_around_lines", turn_around_lines, 0, 65536); })
      .and_then(
          [&] { return in_range("phase_offset_a_scans", scan_lag_a_scans, -a_scans, a_scans); })
      .and_then([&] { return in_range("repeats", repeats, 1, most_repeats); });
}

} // namespace octascope::pipeline
