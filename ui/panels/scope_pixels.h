// Camera pixels to RGBA. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "hal/result.h"
#include "hal/scope_camera.h"

namespace octascope::ui {

// Writes width · height RGBA pixels, rows from the top. YUYV and NV12 are taken as BT.601, limited
// range, what USB and board cameras send. Fault::bad_data: the frame is shorter than its format,
// size and stride say, or `out` is too short; the message has both lengths.
hal::Result<> convert_to_rgba(const hal::ScopeFrame& frame, std::span<std::uint8_t> out);

} // namespace octascope::ui
