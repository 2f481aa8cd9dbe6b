// The scanner's answers on the sync line, compared with the pulses.
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/gpio/gpio_bench.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::GpioGalvoTrigger;
using namespace std::chrono_literals;

class GpioSync : public GpioTest {
protected:
  void answer() {
    EXPECT_TRUE(chip_->pull(sync_line, true));
    EXPECT_TRUE(chip_->pull(sync_line, false));
    // gpio-sim tells of an edge with the kernel's next timer tick, and merges those before it.
    clock_.sleep_for(30ms);
  }
  // So many after each pulse.
  void pulse_and_answer(GpioGalvoTrigger& trigger, std::initializer_list<int> answers) {
    for (const int count : answers) {
      ASSERT_TRUE(trigger.pulse());
      for (int i = 0; i < count; ++i)
        answer();
    }
  }
  static void expect_counted(const GpioGalvoTrigger& trigger, std::uint64_t edges,
                             std::uint64_t missed, std::uint64_t unexpected) {
    EXPECT_EQ(trigger.counters().sync_edges, edges);
    EXPECT_EQ(trigger.counters().missed_edges, missed);
    EXPECT_EQ(trigger.counters().unexpected_edges, unexpected);
  }
};

TEST_F(GpioSync, every_answered_pulse_is_counted_with_its_delay) {
  GpioGalvoTrigger trigger{clock_, {.sync_line = "octascope-sync"}};
  ASSERT_TRUE(trigger.open({}));
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(trigger.pulse());
    answer();
  }
  const auto last = trigger.pulse();
  ASSERT_TRUE(last);
  const auto counters = trigger.counters();
  EXPECT_EQ(counters.pulses, 11U);
  EXPECT_EQ(counters.sync_edges, 10U);
  EXPECT_EQ(counters.missed_edges, 0U);
  EXPECT_EQ(counters.unexpected_edges, 0U);
  EXPECT_TRUE(counters.sync_works);
  EXPECT_GT(counters.sync_delay, 0ns);
  EXPECT_LT(counters.last_sync_edge, *last) << "on the axis of the pulses";
  EXPECT_GT(counters.last_sync_edge, *last - 10s);
}

TEST_F(GpioSync, missing_and_unexpected_answers_are_told_apart) {
  GpioGalvoTrigger trigger{clock_, {.sync_line = "octascope-sync"}};
  ASSERT_TRUE(trigger.open({}));
  answer(); // nobody asked
  pulse_and_answer(trigger, {1, 0, 0, 3, 1, 0, 0});
  expect_counted(trigger, 6, 3, 3);
}

TEST_F(GpioSync, several_answers_a_pulse_can_be_expected) {
  GpioGalvoTrigger trigger{clock_, {.sync_line = "octascope-sync", .sync_edges_per_pulse = 16}};
  ASSERT_TRUE(trigger.open({}));
  pulse_and_answer(trigger, {16, 14, 0});
  expect_counted(trigger, 30, 2, 0);
}

TEST_F(GpioSync, of_more_answers_than_the_kernel_keeps_as_many_are_counted_as_it_keeps) {
  GpioGalvoTrigger trigger{clock_, {.sync_line = "octascope-sync"}};
  ASSERT_TRUE(trigger.open({}));
  pulse_and_answer(trigger, {18, 1, 0});
  expect_counted(trigger, 17, 0, 15);
}

TEST_F(GpioSync, a_sync_line_that_is_not_there_is_told) {
  GpioGalvoTrigger trigger{clock_, {.sync_line = "octascope-answer"}};
  EXPECT_THAT(trigger.open({}), FailsWith(hal::ErrorCode::absent, "octascope-answer"));
  GpioGalvoTrigger other{clock_};
  EXPECT_TRUE(other.open({})) << "the trigger line was given back";
}

TEST_F(GpioSync, a_sync_line_that_goes_away_does_not_stop_the_trigger) {
  auto sync_chip = SimGpioChip::make("octascope-sync-chip", {"scanner-sync"});
  ASSERT_TRUE(sync_chip);
  GpioGalvoTrigger trigger{clock_, {.sync_line = "scanner-sync"}};
  ASSERT_TRUE(trigger.open({}));
  ASSERT_TRUE(trigger.pulse());
  EXPECT_TRUE(trigger.counters().sync_works);
  ASSERT_TRUE((*sync_chip)->remove());
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(trigger.pulse());
  EXPECT_FALSE(trigger.counters().sync_works);
  EXPECT_EQ(trigger.counters().missed_edges, 3U);
}

} // namespace
} // namespace octascope::tests
