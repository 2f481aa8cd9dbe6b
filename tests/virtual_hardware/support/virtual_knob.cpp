#include "tests/virtual_hardware/support/virtual_knob.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <linux/uinput.h>
#include <poll.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"

namespace octascope::tests {

using hal::Result;
using hal::linux_backend::control;
using hal::linux_backend::system_failure;
namespace fs = std::filesystem;

namespace {
constexpr const char* uinput_node = "/dev/uinput";
}

std::string virtual_knob_missing() {
  if (::access(uinput_node, F_OK) != 0)
    return "there is no /dev/uinput: this kernel makes no virtual input devices";
  if (::access(uinput_node, R_OK | W_OK) != 0)
    return "no permission to open /dev/uinput";
  return {};
}

Result<std::unique_ptr<VirtualKnob>> VirtualKnob::plug_in() {
  std::unique_ptr<VirtualKnob> knob{new VirtualKnob};
  auto file = hal::linux_backend::open_device(uinput_node, O_RDWR | O_NONBLOCK);
  if (!file)
    return tl::make_unexpected(file.error());
  knob->uinput_ = std::move(*file);
  const auto has = [&](unsigned long request, long what) {
    return ::ioctl(knob->uinput_.get(), request, what) == 0;
  };
  uinput_setup setup{};
  setup.id = {BUS_USB, 0x077d, 0x0410, 0x0311};
  std::strncpy(setup.name, "Griffin PowerMate", sizeof setup.name - 1);
  std::array<char, 64> folder{};
  if (!has(UI_SET_EVBIT, EV_KEY) || !has(UI_SET_KEYBIT, BTN_0) || !has(UI_SET_EVBIT, EV_REL) ||
      !has(UI_SET_RELBIT, REL_DIAL) || !has(UI_SET_EVBIT, EV_MSC) ||
      !has(UI_SET_MSCBIT, MSC_PULSELED) || control(knob->uinput_, UI_DEV_SETUP, &setup) < 0 ||
      ::ioctl(knob->uinput_.get(), UI_DEV_CREATE) < 0 ||
      control(knob->uinput_, UI_GET_SYSNAME(64), folder.data()) < 0)
    return system_failure(uinput_node, "making a knob", errno);
  knob->folder_ = "/sys/devices/virtual/input/" + std::string{folder.data()};
  for (int tries = 0; tries < 5000; ++tries) {
    const std::string node = knob->event_node();
    if (!node.empty() && ::access(node.c_str(), F_OK) == 0)
      return knob;
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  return hal::fail(hal::Fault::timed_out, "virtual PowerMate: no event node within 5 s");
}

VirtualKnob::~VirtualKnob() {
  ::ioctl(uinput_.get(), UI_DEV_DESTROY);
}

Result<> VirtualKnob::send(int type, int code, int value) {
  input_event events[2]{};
  events[0].type = static_cast<std::uint16_t>(type);
  events[0].code = static_cast<std::uint16_t>(code);
  events[0].value = value;
  events[1].type = EV_SYN;
  events[1].code = SYN_REPORT;
  if (::write(uinput_.get(), events, sizeof events) != sizeof events)
    return system_failure(uinput_node, "sending an event", errno);
  return {};
}

Result<> VirtualKnob::turn(int detents) {
  return send(EV_REL, REL_DIAL, detents);
}

Result<> VirtualKnob::press(bool down) {
  return send(EV_KEY, BTN_0, down ? 1 : 0);
}

std::optional<int> VirtualKnob::lamp() {
  pollfd waiting{uinput_.get(), POLLIN, 0};
  while (::poll(&waiting, 1, 2000) > 0) {
    input_event event{};
    if (::read(uinput_.get(), &event, sizeof event) != sizeof event)
      return std::nullopt;
    if (event.type == EV_MSC && event.code == MSC_PULSELED)
      return event.value;
  }
  return std::nullopt;
}

std::string VirtualKnob::event_node() const {
  std::error_code error;
  for (fs::directory_iterator it{folder_, error}, end; !error && it != end; it.increment(error))
    if (it->path().filename().string().starts_with("event"))
      return "/dev/input/" + it->path().filename().string();
  return {};
}

} // namespace octascope::tests
