// Decodes the events of an input device: the keys of a pedal that acts as a keyboard, the dial and
// button of a PowerMate. Pure, like hid_decoder.h.
#pragma once

#include "hal/linux/hid/decoders/hid_decoder.h"

namespace octascope::hal::linux_backend {

// As in struct input_event.
struct KeyEvent {
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
};

// Threads: one at a time.
class KeyDecoder {
public:
  explicit KeyDecoder(const ControlModel& model);

  // Empty if the event concerns neither switches nor the knob.
  std::optional<HidReading> decode(const KeyEvent& event);

private:
  std::optional<HidReading> key(std::uint16_t code, bool down);

  HidFamily family_;
  std::vector<std::uint16_t> keys_;
  std::uint32_t down_ = 0;
  std::vector<bool> any_down_; // for a pedal on which any key is switch 0
};

} // namespace octascope::hal::linux_backend
