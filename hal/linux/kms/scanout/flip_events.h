// What a card writes into its file when flips are completed. Pure: bytes in, events out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/clock.h"

namespace octascope::hal::linux_backend::kms {

struct FlipEvent {
  std::uint64_t number = 0; // as it was given with the flip
  TimePoint stamp;          // on the card's clock
};

// The first completed flip in the bytes of a read (struct drm_event, drm.h); `bytes` is moved
// behind it. Other events are passed over; a broken one ends the walk.
std::optional<FlipEvent> take_flip(std::span<const std::byte>& bytes);

} // namespace octascope::hal::linux_backend::kms
