// Which of a monitor's modes, by a wish as a person writes it. Pure.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "hal/linux/kms/drm/topology.h"

namespace octascope::hal::linux_backend::kms {

struct ModeWish {
  int width = 0; // 0: whatever the monitor prefers
  int height = 0;
  std::optional<double> refresh_hz;
  bool computed = false; // not one of the monitor's list: timings are computed (CVT)
};

// "" or "preferred"; "1920x1080"; "1920x1080@50"; "1920x1080M@50": computed, for a monitor whose
// list is missing or wrong (M as in the kernel's video= option). ErrorCode::invalid_argument.
Result<ModeWish> parse_mode_wish(std::string_view text);

// ErrorCode::unsupported: the monitor has no such mode; the message lists what it has.
Result<Mode> choose_mode(std::span<const Mode> modes, const ModeWish& wish);

// VESA's Coordinated Video Timings 1.1, standard blanking, progressive, no margins. The width is
// rounded down to a multiple of 8; both sides are at least 100.
Mode computed_mode(int width, int height, double refresh_hz);

} // namespace octascope::hal::linux_backend::kms
