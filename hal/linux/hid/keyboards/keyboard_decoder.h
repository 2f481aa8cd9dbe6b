// From the events of a keyboard's input device to what a display tells of keys. Pure.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/display.h"
#include "hal/linux/hid/decoders/key_decoder.h"

namespace octascope::hal::linux_backend {

// What a key of a keyboard (linux/input-event-codes.h) is to us: a hal::Key or an ASCII code, by
// its place on a US keyboard; 0: nothing. No layout is asked for, as the console's may not be the
// keyboard's.
std::uint16_t key_of_keyboard(std::uint16_t code);

// Threads: one at a time. No allocation.
class KeyboardDecoder {
public:
  // Nothing: it means nothing to us, or it was pressed before we listened.
  std::optional<DisplayEvent> decode(const KeyEvent& event, TimePoint time);

  // One of the keys that are down, as if it were let go; nothing: none is.
  std::optional<DisplayEvent> release_one(TimePoint time);

private:
  static constexpr std::size_t most_codes = 128; // beyond them nothing means anything to us

  std::bitset<most_codes> down_;
};

} // namespace octascope::hal::linux_backend
