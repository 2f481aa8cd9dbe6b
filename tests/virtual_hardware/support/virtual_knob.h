// A Griffin PowerMate without hardware: the kernel's driver for the real one makes the same input
// device (REL_DIAL, BTN_0, MSC_PULSELED), and hidraw never sees it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include <linux/input.h>
#include <poll.h>
#include <unistd.h>

#include "tests/virtual_hardware/support/uinput_device.h"

namespace octascope::tests {

// Pulled out when destroyed. Threads: one at a time.
class VirtualKnob {
public:
  explicit VirtualKnob(std::unique_ptr<UinputDevice> device) : device_{std::move(device)} {}
  static hal::Result<std::unique_ptr<VirtualKnob>> plug_in() {
    constexpr std::array<UinputAbility, 3> abilities{
        {{EV_KEY, BTN_0}, {EV_REL, REL_DIAL}, {EV_MSC, MSC_PULSELED}}};
    return UinputDevice::plug_in("Griffin PowerMate", 0x077d, 0x0410, abilities)
        .map([](auto device) { return std::make_unique<VirtualKnob>(std::move(device)); });
  }

  hal::Result<> turn(int detents) { return device_->send(EV_REL, REL_DIAL, detents); }
  hal::Result<> press(bool down) { return device_->send(EV_KEY, BTN_0, down ? 1 : 0); }

  // What the lamp was last told and nobody has asked for; waits up to 2 s.
  std::optional<int> lamp() {
    pollfd waiting{device_->descriptor(), POLLIN, 0};
    input_event event{};
    while (::poll(&waiting, 1, 2000) > 0 &&
           ::read(device_->descriptor(), &event, sizeof event) == sizeof event)
      if (event.type == EV_MSC && event.code == MSC_PULSELED)
        return event.value;
    return std::nullopt;
  }

  std::string event_node() const { return device_->event_node(); }

private:
  std::unique_ptr<UinputDevice> device_;
};

} // namespace octascope::tests
