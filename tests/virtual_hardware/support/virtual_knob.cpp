#include "tests/virtual_hardware/support/virtual_knob.h"

#include <array>

#include <linux/input.h>
#include <poll.h>
#include <unistd.h>

namespace octascope::tests {

using hal::Result;

Result<std::unique_ptr<VirtualKnob>> VirtualKnob::plug_in() {
  constexpr std::array<UinputAbility, 3> abilities{
      {{EV_KEY, BTN_0}, {EV_REL, REL_DIAL}, {EV_MSC, MSC_PULSELED}}};
  return UinputDevice::plug_in("Griffin PowerMate", 0x077d, 0x0410, abilities)
      .map([](std::unique_ptr<UinputDevice> device) {
        return std::unique_ptr<VirtualKnob>{new VirtualKnob{std::move(device)}};
      });
}

Result<> VirtualKnob::turn(int detents) {
  return device_->send(EV_REL, REL_DIAL, detents);
}

Result<> VirtualKnob::press(bool down) {
  return device_->send(EV_KEY, BTN_0, down ? 1 : 0);
}

std::optional<int> VirtualKnob::lamp() {
  pollfd waiting{device_->descriptor(), POLLIN, 0};
  while (::poll(&waiting, 1, 2000) > 0) {
    input_event event{};
    if (::read(device_->descriptor(), &event, sizeof event) != sizeof event)
      return std::nullopt;
    if (event.type == EV_MSC && event.code == MSC_PULSELED)
      return event.value;
  }
  return std::nullopt;
}

} // namespace octascope::tests
