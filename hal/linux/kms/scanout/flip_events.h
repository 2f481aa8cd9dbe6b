// Decodes the events that a card sends when flips complete. Pure: bytes in, events out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/clock.h"

namespace octascope::hal::linux_backend::kms {

struct FlipEvent {
  std::uint64_t number = 0; // as given to Scanout::flip()
  TimePoint stamp;          // on the card's clock
};

// The first completed flip in the bytes read from the card's file (struct drm_event, drm.h);
// advances `bytes` past it. Skips other events and stops at a malformed one.
std::optional<FlipEvent> take_flip(std::span<const std::byte>& bytes);

} // namespace octascope::hal::linux_backend::kms
