// From the events of an input device to what they say: keys of a pedal that types, dial and button
// of a PowerMate. Pure, as hid_decoder.h.
#pragma once

#include "hal/linux/hid/decoders/hid_decoder.h"

namespace octascope::hal::linux_backend {

// As of struct input_event.
struct KeyEvent {
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
};

// Threads: one at a time.
class KeyDecoder {
public:
  explicit KeyDecoder(const ControlModel& model);

  // Empty: the event concerns neither switches nor the knob.
  std::optional<HidReading> decode(const KeyEvent& event);

private:
  std::optional<HidReading> key(std::uint16_t code, bool down);

  HidFamily family_;
  std::vector<std::uint16_t> keys_;
  std::uint32_t down_ = 0;
  std::vector<bool> any_down_; // of a pedal of which any key is the one switch
};

} // namespace octascope::hal::linux_backend
