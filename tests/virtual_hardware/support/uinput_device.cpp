#include "tests/virtual_hardware/support/uinput_device.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/uinput.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"
#include "tests/virtual_hardware/support/device_node.h"

namespace octascope::tests {

using hal::Result;
using hal::linux_backend::control;
using hal::linux_backend::system_failure;
namespace fs = std::filesystem;

namespace {
constexpr const char* uinput_node = "/dev/uinput";
}

std::string uinput_missing() {
  if (::access(uinput_node, F_OK) != 0)
    return "there is no /dev/uinput: this kernel makes no virtual input devices";
  if (::access(uinput_node, R_OK | W_OK) != 0)
    return "no permission to open /dev/uinput";
  return {};
}

bool UinputDevice::allow(const UinputAbility& ability) const {
  const unsigned long request = ability.type == EV_KEY   ? UI_SET_KEYBIT
                                : ability.type == EV_REL ? UI_SET_RELBIT
                                                         : UI_SET_MSCBIT;
  return ::ioctl(file_.get(), UI_SET_EVBIT, ability.type) == 0 &&
         ::ioctl(file_.get(), request, ability.code) == 0;
}

Result<std::unique_ptr<UinputDevice>>
UinputDevice::plug_in(const char* name, std::uint16_t vendor, std::uint16_t product,
                      std::span<const UinputAbility> abilities) {
  std::unique_ptr<UinputDevice> device{new UinputDevice};
  HAL_TRY(auto file, hal::linux_backend::open_device(uinput_node, O_RDWR | O_NONBLOCK));
  device->file_ = std::move(file);
  uinput_setup setup{};
  setup.id = {BUS_USB, vendor, product, 1};
  std::strncpy(setup.name, name, sizeof setup.name - 1);
  std::array<char, 64> folder{};
  if (!std::ranges::all_of(abilities, [&](const auto& one) { return device->allow(one); }) ||
      control(device->file_, UI_DEV_SETUP, &setup) < 0 ||
      ::ioctl(device->descriptor(), UI_DEV_CREATE) < 0 ||
      control(device->file_, UI_GET_SYSNAME(64), folder.data()) < 0)
    return system_failure(uinput_node, "making an input device", errno);
  device->folder_ = "/sys/devices/virtual/input/" + std::string{folder.data()};
  if (!node_appears([&] { return device->event_node(); }))
    return hal::fail(hal::ErrorCode::timed_out,
                     fmt::format("virtual {}: no event node within 5 s", name));
  return device;
}

UinputDevice::~UinputDevice() {
  ::ioctl(file_.get(), UI_DEV_DESTROY);
}

Result<> UinputDevice::send(std::uint16_t type, std::uint16_t code, std::int32_t value) {
  std::array<input_event, 2> events{};
  events[0].type = type;
  events[0].code = code;
  events[0].value = value;
  events[1].type = EV_SYN;
  events[1].code = SYN_REPORT;
  if (::write(file_.get(), events.data(), sizeof events) != sizeof events)
    return system_failure(uinput_node, "sending an event", errno);
  return {};
}

std::string UinputDevice::event_node() const {
  std::error_code error;
  for (fs::directory_iterator it{folder_, error}, end; !error && it != end; it.increment(error))
    if (it->path().filename().string().starts_with("event"))
      return "/dev/input/" + it->path().filename().string();
  return {};
}

} // namespace octascope::tests
