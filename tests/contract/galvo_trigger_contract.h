// What every hal::GalvoTrigger must do. A backend brings a GalvoTriggerBench and instantiates
// GalvoTriggerContract with it.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "hal/galvo_trigger.h"
#include "tests/contract/contract_case.h"
#include "tests/support/allocation_counter.h"

namespace octascope::tests {

// A trigger in its surroundings. A fresh bench has a closed trigger that is plugged in.
class GalvoTriggerBench {
public:
  virtual ~GalvoTriggerBench() = default;
  virtual hal::GalvoTrigger& trigger() = 0;
  virtual hal::Clock& clock() = 0;

  // Rising edges that came out at the other end of the line.
  virtual std::uint64_t pulses_seen() const = 0;

  virtual bool can_unplug() const { return false; }
  virtual void unplug() {}
  virtual void replug() {}
};

using GalvoTriggerCase = ContractCase<GalvoTriggerBench>;

class GalvoTriggerContract : public testing::TestWithParam<GalvoTriggerCase> {
protected:
  std::unique_ptr<GalvoTriggerBench> bench_ = GetParam().make();
  hal::GalvoTrigger& trigger_ = bench_->trigger();
  hal::Clock& clock_ = bench_->clock();
  const hal::GalvoTriggerConfig config_;
};

TEST_P(GalvoTriggerContract, walks_through_its_states) {
  EXPECT_FALSE(trigger_.backend().empty());
  EXPECT_EQ(trigger_.state(), hal::DeviceState::absent);
  trigger_.close();
  EXPECT_EQ(trigger_.state(), hal::DeviceState::absent);
  ASSERT_TRUE(trigger_.open(config_));
  EXPECT_EQ(trigger_.state(), hal::DeviceState::ready);
  trigger_.close();
  EXPECT_EQ(trigger_.state(), hal::DeviceState::absent);
  ASSERT_TRUE(trigger_.open(config_)) << "and again";
}

TEST_P(GalvoTriggerContract, refuses_calls_in_the_wrong_order) {
  expect_fault(trigger_.pulse(), hal::ErrorCode::invalid_argument);
  ASSERT_TRUE(trigger_.open(config_));
  expect_fault(trigger_.open(config_), hal::ErrorCode::invalid_argument);
  EXPECT_EQ(trigger_.state(), hal::DeviceState::ready);
  EXPECT_TRUE(trigger_.pulse());
  trigger_.close();
  expect_fault(trigger_.pulse(), hal::ErrorCode::invalid_argument);
  EXPECT_EQ(bench_->pulses_seen(), 1U);
}

TEST_P(GalvoTriggerContract, refuses_impossible_pulses) {
  for (const std::int64_t width_ns : {0, -1}) {
    expect_fault(trigger_.open({.pulse_width = hal::Duration{width_ns}}),
                 hal::ErrorCode::invalid_argument);
    EXPECT_EQ(trigger_.state(), hal::DeviceState::absent);
  }
  EXPECT_TRUE(trigger_.open(config_));
}

TEST_P(GalvoTriggerContract, opening_and_closing_make_no_pulse) {
  ASSERT_TRUE(trigger_.open(config_));
  trigger_.close();
  ASSERT_TRUE(trigger_.open(config_));
  EXPECT_EQ(bench_->pulses_seen(), 0U);
}

TEST_P(GalvoTriggerContract, each_arm_is_one_pulse_with_the_time_of_its_edge) {
  ASSERT_TRUE(trigger_.open(config_));
  hal::TimePoint last = clock_.now();
  for (std::uint64_t pulses = 1; pulses <= 20; ++pulses) {
    const hal::TimePoint called = clock_.now();
    const auto edge = trigger_.pulse();
    ASSERT_TRUE(edge) << edge.error().message;
    EXPECT_GE(*edge, called);
    EXPECT_LE(*edge, clock_.now());
    if (pulses > 1) {
      EXPECT_GE(*edge - last, config_.pulse_width) << "an edge rises only after the last one fell";
    }
    last = *edge;
    EXPECT_EQ(bench_->pulses_seen(), pulses);
  }
}

TEST_P(GalvoTriggerContract, arming_allocates_nothing) {
  ASSERT_TRUE(trigger_.open(config_));
  const std::uint64_t before = allocations_of_this_thread();
  const bool pulsed = trigger_.pulse().has_value() && trigger_.pulse().has_value();
  EXPECT_EQ(allocations_of_this_thread(), before);
  EXPECT_TRUE(pulsed);
}

TEST_P(GalvoTriggerContract, a_disconnect_is_told_and_survived) {
  if (!bench_->can_unplug())
    GTEST_SKIP() << "this bench cannot unplug its trigger";
  ASSERT_TRUE(trigger_.open(config_));
  ASSERT_TRUE(trigger_.pulse());
  bench_->unplug();
  expect_fault(trigger_.pulse(), hal::ErrorCode::disconnected);
  EXPECT_EQ(trigger_.state(), hal::DeviceState::failed);
  expect_fault(trigger_.pulse(), hal::ErrorCode::disconnected);
  expect_fault(trigger_.open(config_), hal::ErrorCode::invalid_argument);
  trigger_.close();
  EXPECT_EQ(trigger_.state(), hal::DeviceState::absent);
  expect_fault(trigger_.open(config_), hal::ErrorCode::absent);
  EXPECT_EQ(trigger_.state(), hal::DeviceState::absent);
  EXPECT_EQ(bench_->pulses_seen(), 1U);
  bench_->replug();
  ASSERT_TRUE(trigger_.open(config_));
  EXPECT_TRUE(trigger_.pulse());
  EXPECT_EQ(bench_->pulses_seen(), 2U);
}

} // namespace octascope::tests
