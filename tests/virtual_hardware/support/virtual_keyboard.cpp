#include "tests/virtual_hardware/support/virtual_keyboard.h"

#include <cerrno>
#include <vector>

#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>

#include "hal/linux/system/system_error.h"

namespace octascope::tests {

using hal::Result;

namespace {
constexpr std::uint16_t most_keys = 128; // of one with letters, a block of numbers and arrows
}

Result<std::unique_ptr<VirtualKeyboard>> VirtualKeyboard::plug_in(std::uint16_t vendor,
                                                                  std::uint16_t product) {
  std::vector<UinputAbility> keys;
  for (std::uint16_t key = 1; key < most_keys; ++key)
    keys.push_back({EV_KEY, key});
  return UinputDevice::plug_in("Keyboard of the bench", vendor, product, keys)
      .map([](std::unique_ptr<UinputDevice> device) {
        return std::unique_ptr<VirtualKeyboard>{new VirtualKeyboard{std::move(device)}};
      });
}

Result<> VirtualKeyboard::set(std::uint16_t key, bool is_down) {
  return device_->send(EV_KEY, key, is_down ? 1 : 0);
}

bool VirtualKeyboard::is_grabbed() const {
  const auto file = hal::linux_backend::open_device(event_node(), O_RDWR | O_NONBLOCK);
  return file && ::ioctl(file->get(), EVIOCGRAB, 1) != 0 && errno == EBUSY; // else it is let go
}

} // namespace octascope::tests
