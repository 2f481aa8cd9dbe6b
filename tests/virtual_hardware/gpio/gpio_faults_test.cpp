// What can be wrong with a GPIO line: told in words, survived, over when it is over.
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/gpio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hal/linux/gpio/gpio_lookup.h"
#include "hal/linux/system/system_error.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/gpio/gpio_bench.h"
#include "tests/virtual_hardware/support/resource_count.h"
#include "tests/virtual_hardware/support/without_permission.h"

namespace octascope::tests {
namespace {

using hal::ErrorCode;
using hal::linux_backend::FileDescriptor;
using hal::linux_backend::GpioGalvoTrigger;
using testing::HasSubstr;
using namespace std::chrono_literals;

class GpioFaults : public GpioTest {};

// As another program would hold it.
FileDescriptor hold(const std::string& node, unsigned line, const char* consumer) {
  const auto chip = hal::linux_backend::open_device(node, O_RDWR);
  EXPECT_TRUE(chip);
  gpiohandle_request request{};
  request.lineoffsets[0] = line;
  request.lines = 1;
  request.flags = GPIOHANDLE_REQUEST_INPUT;
  std::strncpy(request.consumer_label, consumer, sizeof request.consumer_label - 1);
  EXPECT_EQ(hal::linux_backend::control(*chip, GPIO_GET_LINEHANDLE_IOCTL, &request), 0);
  return FileDescriptor{request.fd};
}

TEST_F(GpioFaults, a_line_held_by_another_names_the_holder_until_it_is_free) {
  FileDescriptor other = hold(chip_->node(), trigger_line, "pump-control");
  GpioGalvoTrigger trigger{clock_};
  EXPECT_THAT(trigger.open({}), FailsWith(ErrorCode::busy, "octascope-trigger", "pump-control"));
  EXPECT_EQ(trigger.state(), hal::DeviceState::absent);
  other.reset();
  EXPECT_TRUE(trigger.open({}));
}

TEST_F(GpioFaults, an_open_trigger_holds_its_line_under_its_name) {
  GpioGalvoTrigger first{clock_}, second{clock_};
  ASSERT_TRUE(first.open({}));
  EXPECT_THAT(second.open({}), FailsWith(ErrorCode::busy, "held by \"octascope\""));
  first.close();
  EXPECT_TRUE(second.open({}));
}

TEST_F(GpioFaults, an_unknown_line_is_never_guessed) {
  GpioGalvoTrigger trigger{clock_, {.line = "pump"}};
  EXPECT_THAT(trigger.open({}),
              FailsWith(ErrorCode::absent, "\"pump\"", "6 lines", "octascope devices"));
}

TEST_F(GpioFaults, a_name_that_two_lines_have_is_refused) {
  const auto second =
      SimGpioChip::make("octascope-second-" + std::to_string(::getpid()), {"octascope-trigger"});
  ASSERT_TRUE(second);
  GpioGalvoTrigger trigger{clock_};
  EXPECT_THAT(trigger.open({}), FailsWith(ErrorCode::invalid_argument, "2 lines"));
  const std::string chip = chip_->node().substr(std::strlen("/dev/"));
  GpioGalvoTrigger exact{clock_, {.line = chip + ":3"}};
  ASSERT_TRUE(exact.open({.pulse_width = 10s}));
  ASSERT_TRUE(exact.pulse());
  EXPECT_TRUE(chip_->level(trigger_line));
  EXPECT_FALSE((*second)->level(0));
}

TEST_F(GpioFaults, an_offset_that_the_chip_does_not_have_is_refused) {
  const std::string chip = chip_->node().substr(std::strlen("/dev/"));
  GpioGalvoTrigger trigger{clock_, {.line = chip + ":6"}};
  EXPECT_THAT(trigger.open({}), FailsWith(ErrorCode::invalid_argument, "0 to 5"));
}

TEST_F(GpioFaults, without_permission_the_message_says_which_group) {
  while (hal::linux_backend::udev_is_at_work()) // it is not denied before
    std::this_thread::sleep_for(10ms);
  ASSERT_EQ(::chmod(chip_->node().c_str(), 0600), 0);
  check_as_nobody([&] {
    EXPECT_THAT(GpioGalvoTrigger{clock_}.open({}),
                FailsWith(ErrorCode::denied, "usermod -aG gpio"));
  });
}

TEST_F(GpioFaults, a_chip_that_goes_in_the_middle_of_a_long_pulse_is_survived) {
  GpioGalvoTrigger trigger{clock_};
  ASSERT_TRUE(trigger.open({.pulse_width = 20ms}));
  ASSERT_TRUE(trigger.pulse());
  ASSERT_TRUE(chip_->remove());
  EXPECT_THAT(trigger.pulse(), FailsWith(ErrorCode::disconnected, "octascope-trigger"));
  EXPECT_EQ(trigger.state(), hal::DeviceState::failed);
  trigger.close();
  EXPECT_THAT(trigger.open({}), FailsWith(ErrorCode::absent, "octascope-trigger"));
  ASSERT_TRUE(chip_->restore());
  ASSERT_TRUE(trigger.open({.pulse_width = 20ms}));
  EXPECT_FALSE(chip_->level(trigger_line));
  ASSERT_TRUE(trigger.pulse());
  EXPECT_TRUE(await_level(false));
}

// Every second time of 200 the chip goes while its line is held.
TEST_F(GpioFaults, two_hundred_plug_cycles_leak_nothing) {
  const auto chip = SimGpioChip::make("octascope-cycles", {"cycled-trigger"});
  ASSERT_TRUE(chip);
  GpioGalvoTrigger trigger{clock_, {.line = "cycled-trigger"}};
  const auto cycle = [&](bool in_use) {
    ASSERT_TRUE(trigger.open({.pulse_width = in_use ? 1ms : 50us}));
    ASSERT_TRUE(trigger.pulse());
    if (!in_use)
      trigger.close();
    ASSERT_TRUE((*chip)->remove());
    ASSERT_FALSE(trigger.pulse());
    trigger.close();
    ASSERT_FALSE(trigger.open({}));
    ASSERT_TRUE((*chip)->restore());
  };
  for (int i = 0; i < 10; ++i) // libraries and locales take their share at first
    cycle(i % 2 == 0);
  const ResourceCount before = resources_in_use();
  for (int i = 0; i < 200 && !HasFatalFailure(); ++i)
    cycle(i % 2 == 0);
  expect_no_leak(before);
}

TEST_F(GpioFaults, two_hundred_openings_leak_nothing) {
  GpioGalvoTrigger trigger{clock_, {.sync_line = "octascope-sync"}};
  GpioGalvoTrigger refused{clock_, {.line = "octascope-sync"}};
  const auto cycle = [&](hal::Duration width) {
    ASSERT_TRUE(trigger.open({.pulse_width = width}));
    ASSERT_TRUE(trigger.pulse());
    ASSERT_FALSE(refused.open({}));
    trigger.close();
  };
  // The C library keeps up to seven freed blocks of each size, which count as in use.
  for (int i = 0; i < 40; ++i)
    cycle(i % 2 == 0 ? 1ms : 50us);
  const ResourceCount before = resources_in_use();
  for (int i = 0; i < 200 && !HasFatalFailure(); ++i)
    cycle(i % 2 == 0 ? 1ms : 50us);
  expect_no_leak(before);
}

TEST_F(GpioFaults, the_survey_says_what_is_there_and_what_is_missing) {
  using hal::linux_backend::gpio_complaint;
  using hal::linux_backend::survey_gpio;
  EXPECT_EQ(gpio_complaint(survey_gpio(), "octascope-trigger"), "");
  EXPECT_THAT(gpio_complaint(survey_gpio(), "pump"), HasSubstr("expected"));
  const FileDescriptor other = hold(chip_->node(), trigger_line, "pump-control");
  EXPECT_THAT(gpio_complaint(survey_gpio(), "octascope-trigger"), HasSubstr("pump-control"));
}

} // namespace
} // namespace octascope::tests
