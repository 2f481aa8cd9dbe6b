// Chooses one of a monitor's modes, from a text in the configuration. Pure.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "hal/linux/kms/drm/topology.h"

namespace octascope::hal::linux_backend::kms {

struct ModeRequest {
  int width = 0; // 0: the monitor's preferred mode
  int height = 0;
  std::optional<double> refresh_hz;
  bool computed = false; // not from the monitor's list: the timings are computed (CVT)
};

// "" or "preferred"; "1920x1080"; "1920x1080@50"; "1920x1080M@50": computed, for a monitor whose
// list is missing or wrong (M as in the kernel's video= option). ErrorCode::invalid_argument.
Result<ModeRequest> parse_mode_request(std::string_view text);

// ErrorCode::unsupported: the monitor has no such mode; the message lists those it has.
Result<Mode> choose_mode(std::span<const Mode> modes, const ModeRequest& wanted);

// VESA Coordinated Video Timings 1.1, standard blanking, progressive, no margins. The width is
// rounded down to a multiple of 8; width and height are at least 100.
Mode computed_mode(int width, int height, double refresh_hz);

} // namespace octascope::hal::linux_backend::kms
