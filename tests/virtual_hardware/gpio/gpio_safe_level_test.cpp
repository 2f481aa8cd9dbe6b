// The line is low whenever no pulse is being made: however long a pulse is, and however the
// program ends.
#include <csignal>

#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/allocation_counter.h"
#include "tests/virtual_hardware/gpio/gpio_bench.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::GpioGalvoTrigger;
using namespace std::chrono_literals;

class GpioSafeLevel : public GpioTest {};

TEST_F(GpioSafeLevel, a_long_pulse_does_not_hold_the_caller_and_ends_by_itself) {
  GpioGalvoTrigger trigger{clock_};
  ASSERT_TRUE(trigger.open({.pulse_width = 500ms}));
  const hal::TimePoint called = clock_.now();
  const std::uint64_t allocations = allocations_of_this_thread();
  const auto first = trigger.pulse();
  EXPECT_EQ(allocations_of_this_thread(), allocations);
  ASSERT_TRUE(first);
  EXPECT_LT(clock_.now() - called, 250ms);
  EXPECT_TRUE(chip_->level(trigger_line));
  EXPECT_TRUE(await_level(false));
  EXPECT_GE(clock_.now() - *first, 499ms);

  const auto second = trigger.pulse();
  const auto third = trigger.pulse();
  ASSERT_TRUE(second && third);
  EXPECT_GE(*third - *second, 499ms) << "an edge rises only after the last one fell";
}

TEST_F(GpioSafeLevel, closing_in_the_middle_of_a_pulse_ends_it) {
  GpioGalvoTrigger trigger{clock_};
  ASSERT_TRUE(trigger.open({.pulse_width = 10s}));
  ASSERT_TRUE(trigger.pulse());
  ASSERT_TRUE(chip_->level(trigger_line));
  trigger.close();
  EXPECT_FALSE(chip_->level(trigger_line));
}

TEST_F(GpioSafeLevel, a_trigger_that_goes_out_of_scope_leaves_it_low) {
  {
    GpioGalvoTrigger trigger{clock_};
    ASSERT_TRUE(trigger.open({.pulse_width = 10s}));
    ASSERT_TRUE(trigger.pulse());
  }
  EXPECT_FALSE(chip_->level(trigger_line));
}

// A line that something pulls up is high until it is taken.
TEST_F(GpioSafeLevel, taking_a_line_that_is_high_drives_it_low) {
  ASSERT_TRUE(chip_->pull(trigger_line, true));
  EXPECT_TRUE(chip_->level(trigger_line));
  GpioGalvoTrigger trigger{clock_};
  ASSERT_TRUE(trigger.open({}));
  EXPECT_FALSE(chip_->level(trigger_line));
}

// A child in the middle of a pulse of 60 s; `at_start` runs in it first.
template <class AtStart> pid_t start_pulsing_child(AtStart&& at_start) {
  const pid_t child = ::fork();
  if (child == 0) {
    hal::linux_backend::MonotonicClock clock;
    GpioGalvoTrigger trigger{clock};
    at_start(trigger);
    if (trigger.open({.pulse_width = 60s}) && trigger.pulse())
      for (;;)
        ::pause();
    ::_exit(1);
  }
  return child;
}

TEST_F(GpioSafeLevel, a_killed_program_does_not_leave_it_high) {
  const pid_t child = start_pulsing_child([](GpioGalvoTrigger&) {});
  ASSERT_TRUE(await_level(true)) << "the pulse has begun";
  ASSERT_EQ(::kill(child, SIGKILL), 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_TRUE(await_level(false));
  GpioGalvoTrigger next{clock_};
  ASSERT_TRUE(next.open({})) << "the line is free again";
  EXPECT_TRUE(next.pulse());
}

GpioGalvoTrigger* to_be_made_safe = nullptr; // of the child below: a signal's handler has no `this`

// gpio-sim lets a released line go where its pull resistor draws it: up here, so that only what the
// handler does can be what makes it low.
TEST_F(GpioSafeLevel, the_handler_of_a_fatal_signal_can_drive_it_low) {
  ASSERT_TRUE(chip_->pull(trigger_line, true));
  const pid_t child = start_pulsing_child([](GpioGalvoTrigger& trigger) {
    to_be_made_safe = &trigger;
    std::signal(SIGSEGV, [](int) {
      to_be_made_safe->make_safe();
      for (;;)
        ::pause(); // lets the other side look before the kernel takes the line
    });
  });
  // High before, low when taken, high in the pulse: wait for the pulse by the child's own clock.
  ASSERT_TRUE(await_level(true));
  clock_.sleep_for(500ms);
  ASSERT_TRUE(await_level(true));
  ASSERT_EQ(::kill(child, SIGSEGV), 0);
  EXPECT_TRUE(await_level(false));
  ::kill(child, SIGKILL);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
}

} // namespace
} // namespace octascope::tests
