// A keyboard without hardware.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "hal/result.h"
#include "tests/virtual_hardware/support/uinput_device.h"

namespace octascope::tests {

// Pulled out when destroyed. Threads: one at a time.
class VirtualKeyboard {
public:
  static hal::Result<std::unique_ptr<VirtualKeyboard>> plug_in(std::uint16_t vendor,
                                                               std::uint16_t product);

  // `key` as in linux/input-event-codes.h.
  hal::Result<> set(std::uint16_t key, bool is_down);

  // Does somebody have it for himself alone?
  bool is_grabbed() const;

  std::string event_node() const { return device_->event_node(); }

private:
  explicit VirtualKeyboard(std::unique_ptr<UinputDevice> device) : device_{std::move(device)} {}

  std::unique_ptr<UinputDevice> device_;
};

} // namespace octascope::tests
