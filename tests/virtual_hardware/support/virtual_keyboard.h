// A keyboard without hardware.
#pragma once

#include <cerrno>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>

#include "hal/linux/system/system_error.h"
#include "tests/virtual_hardware/support/uinput_device.h"

namespace octascope::tests {

// Pulled out when destroyed. Threads: one at a time.
class VirtualKeyboard {
public:
  explicit VirtualKeyboard(std::unique_ptr<UinputDevice> device) : device_{std::move(device)} {}
  static hal::Result<std::unique_ptr<VirtualKeyboard>> plug_in(std::uint16_t vendor,
                                                               std::uint16_t product) {
    std::vector<UinputAbility> keys; // letters, a block of numbers and arrows
    for (std::uint16_t key = 1; key < 128; ++key)
      keys.push_back({EV_KEY, key});
    return UinputDevice::plug_in("Keyboard of the bench", vendor, product, keys)
        .map([](auto device) { return std::make_unique<VirtualKeyboard>(std::move(device)); });
  }

  // `key` as in linux/input-event-codes.h.
  hal::Result<> set(std::uint16_t key, bool is_down) {
    return device_->send(EV_KEY, key, is_down ? 1 : 0);
  }

  // Does somebody have it for himself alone?
  bool is_grabbed() const {
    const auto file = hal::linux_backend::open_device(event_node(), O_RDWR | O_NONBLOCK);
    return file && ::ioctl(file->get(), EVIOCGRAB, 1) != 0 && errno == EBUSY; // else it is let go
  }

  std::string event_node() const { return device_->event_node(); }

private:
  std::unique_ptr<UinputDevice> device_;
};

} // namespace octascope::tests
