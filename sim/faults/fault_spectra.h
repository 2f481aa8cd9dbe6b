// The effect of faults on a frame's bytes.
//
// All functions write whole frames to the caller's memory, allocate nothing and depend only on
// their arguments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/line_camera.h"

namespace octascope::sim {

// Repeats `frame` until `out` is full: the bytes of an overlong frame, or a plain copy.
void fill_with_frame(std::span<const std::byte> frame, std::span<std::byte> out);

// Overlays every one of `bytes` with noise.
void scramble(std::span<std::byte> bytes, std::uint64_t seed);

// Drives every sample of about `line_share` of the lines to full scale, chosen by the seed. Returns
// the number of lines. `frame` is format.frame_bytes() long.
int saturate_lines(const hal::LineFormat& format, std::span<std::byte> frame, double line_share,
                   std::uint64_t seed);

} // namespace octascope::sim
