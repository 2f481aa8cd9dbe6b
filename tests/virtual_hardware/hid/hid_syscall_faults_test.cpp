// HID controls while system calls fail, one after the other.
#include <array>
#include <cstdio>

#include <hidapi.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>

#include "tests/virtual_hardware/hid/hid_bench.h"
#include "tests/virtual_hardware/support/syscall_faults.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::HidControls;
using namespace std::chrono_literals;

constexpr std::uint8_t key_b = 5; // as HID numbers keys

// hidapi 0.13 uses its device after it was freed where the first ioctl() of an opening fails
// (libusb/hidapi issue 542).
constexpr unsigned long spared =
    HID_API_VERSION < HID_API_MAKE_VERSION(0, 14, 0) ? HIDIOCGRDESCSIZE : 0;

class HidSyscallFaults : public HidTest {
protected:
  // Opens, reads what two controls say, and closes: what is wrong with how it ended.
  std::optional<std::string> use(VirtualPedal& pedal, VirtualPedal& typing) {
    HidControls controls{clock_};
    if (const auto opened = controls.open(); !opened) {
      if (controls.state() != hal::DeviceState::absent)
        return "not opened, and not absent";
      return opened.error().message.empty() ? std::optional<std::string>{"no message"}
                                            : std::nullopt;
    }
    std::array<hal::ControlEvent, 8> events;
    for (const std::uint8_t down :
         {std::uint8_t{1}, std::uint8_t{0}}) { // what is not sent, for it was hit, is not read
      (void)pedal.send({down, 0});
      (void)typing.send({1, 0, 0, down != 0 ? key_b : std::uint8_t{0}, 0, 0, 0, 0, 0});
      const auto count = controls.read(events, 7ms);
      if (!count && controls.state() != hal::DeviceState::failed)
        return "an error, and not failed: " + count.error().message;
      if (!count)
        break;
    }
    controls.close();
    return std::nullopt;
  }
};

TEST_F(HidSyscallFaults, hidapi_and_evdev_end_well) {
  const auto pedal = plug_in(vec_pedal());
  const auto typing = plug_in(pcsensor_pedal());
  ASSERT_TRUE(pedal && typing);
  const SyscallFaultReport report = inject_faults(
      every_kind, usual_errors(), [&] { return use(*pedal, *typing); }, false, spared);
  expect_good(report, 41);
  EXPECT_EQ(use(*pedal, *typing), std::nullopt);
}

} // namespace
} // namespace octascope::tests
