#include "tests/virtual_hardware/support/virtual_keyboard.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <linux/uinput.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"

namespace octascope::tests {

using hal::Result;
using hal::linux_backend::control;
using hal::linux_backend::system_failure;
namespace fs = std::filesystem;

namespace {
constexpr const char* uinput_node = "/dev/uinput";
constexpr int most_keys = 128; // of a keyboard with letters, a block of numbers and arrows
} // namespace

Result<std::unique_ptr<VirtualKeyboard>> VirtualKeyboard::plug_in(std::uint16_t vendor,
                                                                  std::uint16_t product) {
  std::unique_ptr<VirtualKeyboard> keyboard{new VirtualKeyboard};
  auto file = hal::linux_backend::open_device(uinput_node, O_RDWR | O_NONBLOCK);
  if (!file)
    return tl::make_unexpected(file.error());
  keyboard->uinput_ = std::move(*file);
  const int descriptor = keyboard->uinput_.get();
  bool made = ::ioctl(descriptor, UI_SET_EVBIT, EV_KEY) == 0;
  for (int key = 1; key < most_keys; ++key)
    made = made && ::ioctl(descriptor, UI_SET_KEYBIT, key) == 0;
  uinput_setup setup{};
  setup.id = {BUS_USB, vendor, product, 1};
  std::strncpy(setup.name, "Keyboard of the bench", sizeof setup.name - 1);
  std::array<char, 64> folder{};
  if (!made || control(keyboard->uinput_, UI_DEV_SETUP, &setup) < 0 ||
      ::ioctl(descriptor, UI_DEV_CREATE) < 0 ||
      control(keyboard->uinput_, UI_GET_SYSNAME(64), folder.data()) < 0)
    return system_failure(uinput_node, "making a keyboard", errno);
  keyboard->folder_ = "/sys/devices/virtual/input/" + std::string{folder.data()};
  for (int tries = 0; tries < 5000; ++tries) {
    const std::string node = keyboard->event_node();
    if (!node.empty() && ::access(node.c_str(), F_OK) == 0)
      return keyboard;
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  return hal::fail(hal::Fault::timed_out, "virtual keyboard: no event node within 5 s");
}

VirtualKeyboard::~VirtualKeyboard() {
  ::ioctl(uinput_.get(), UI_DEV_DESTROY);
}

Result<> VirtualKeyboard::set(std::uint16_t key, bool is_down) {
  std::array<input_event, 2> events{};
  events[0].type = EV_KEY;
  events[0].code = key;
  events[0].value = is_down ? 1 : 0;
  events[1].type = EV_SYN;
  events[1].code = SYN_REPORT;
  if (::write(uinput_.get(), events.data(), sizeof events) != sizeof events)
    return system_failure(uinput_node, "typing", errno);
  return {};
}

bool VirtualKeyboard::is_grabbed() const {
  const auto file = hal::linux_backend::open_device(event_node(), O_RDWR | O_NONBLOCK);
  return file && ::ioctl(file->get(), EVIOCGRAB, 1) != 0 && errno == EBUSY; // else it is let go
}

std::string VirtualKeyboard::event_node() const {
  std::error_code error;
  for (fs::directory_iterator it{folder_, error}, end; !error && it != end; it.increment(error))
    if (it->path().filename().string().starts_with("event"))
      return "/dev/input/" + it->path().filename().string();
  return {};
}

} // namespace octascope::tests
