// The GPIO trigger while system calls fail, one after the other.
#include <optional>
#include <string>

#include "tests/virtual_hardware/gpio/gpio_bench.h"
#include "tests/virtual_hardware/support/syscall_faults.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::GpioGalvoTrigger;
using namespace std::chrono_literals;

class GpioSyscallFaults : public GpioTest {
protected:
  // Opens, makes three pulses and closes: what is wrong with how it ended.
  std::optional<std::string> pulse_three_times(hal::Duration width) {
    GpioGalvoTrigger trigger{clock_, {.sync_line = "octascope-sync"}};
    if (const auto opened = trigger.open({.pulse_width = width}); !opened) {
      if (trigger.state() != hal::DeviceState::absent)
        return "not opened, and not absent";
      return opened.error().message.empty() ? std::optional<std::string>{"no message"}
                                            : std::nullopt;
    }
    for (int i = 0; i < 3; ++i) {
      const auto edge = trigger.pulse();
      if (!edge && trigger.state() != hal::DeviceState::failed)
        return "an error, and not failed: " + edge.error().message;
      if (!edge)
        break;
    }
    trigger.close();
    return std::nullopt;
  }
};

TEST_F(GpioSyscallFaults, short_and_long_pulses_end_well) {
  for (const hal::Duration width : {hal::Duration{50us}, hal::Duration{1ms}}) {
    const SyscallFaultReport report =
        inject_faults(every_kind, usual_errors(), [&] { return pulse_three_times(width); });
    expect_good(report, 21);
    EXPECT_FALSE(chip_->level(trigger_line));
  }
}

} // namespace
} // namespace octascope::tests
