// From the events of a keyboard's input device to what a display tells of keys. Pure.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/display.h"
#include "hal/linux/hid/decoders/key_decoder.h"

namespace octascope::hal::linux_backend {

// The hal::Key or ASCII code of a key (linux/input-event-codes.h), by its place on a US keyboard;
// 0: not reported. The console's layout is not used, because it may not be the keyboard's.
std::uint16_t key_of_keyboard(std::uint16_t code);

// Threads: one at a time. No allocation.
class KeyboardDecoder {
public:
  // Empty: a key that is not reported, or one that was pressed before we listened.
  std::optional<DisplayEvent> decode(const KeyEvent& event, TimePoint time);

  // One of the keys that are down, as if it were let go; nothing: none is.
  std::optional<DisplayEvent> release_one(TimePoint time);

private:
  static constexpr std::size_t most_codes = 128; // higher codes are not reported

  std::bitset<most_codes> down_;
};

} // namespace octascope::hal::linux_backend
