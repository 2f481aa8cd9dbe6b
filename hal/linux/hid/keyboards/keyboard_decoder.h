// Turns the events of a keyboard's input device into a display's key events. Pure.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/display.h"
#include "hal/linux/hid/decoders/key_decoder.h"

namespace octascope::hal::linux_backend {

// The hal::Key or ASCII code of a key (linux/input-event-codes.h) by its place on a US keyboard; 0:
// not reported. The console's layout is ignored, because it may not be the keyboard's.
std::uint16_t key_of_keyboard(std::uint16_t code);

// Threads: one at a time. Does not allocate.
class KeyboardDecoder {
public:
  // Empty for a key that is not reported, or whose press was not received.
  std::optional<DisplayEvent> decode(const KeyEvent& event, TimePoint time);

  // Reports one of the pressed keys as released; empty if none is pressed.
  std::optional<DisplayEvent> release_one(TimePoint time);

private:
  static constexpr std::size_t most_codes = 128; // higher codes are not reported

  std::bitset<most_codes> down_;
};

} // namespace octascope::hal::linux_backend
