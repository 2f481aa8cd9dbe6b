// What faults do to the bytes of a frame.
//
// All functions write whole frames to memory of the caller, allocate nothing and depend on nothing
// but their arguments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/line_camera.h"

namespace octascope::sim {

// Repeats `frame` until `out` is full: the bytes of a frame that came too long, or a plain copy.
void fill_with_frame(std::span<const std::byte> frame, std::span<std::byte> out);

// Overlays `bytes` with noise that covers every one of them.
void scramble(std::span<std::byte> bytes, std::uint64_t seed);

// Drives every sample of about `line_share` of the lines to full scale; the seed chooses which.
// Returns how many lines that were. `frame` is format.frame_bytes() long.
int saturate_lines(const hal::LineFormat& format, std::span<std::byte> frame, double line_share,
                   std::uint64_t seed);

} // namespace octascope::sim
