// What every hal::ControlInput must do. A backend brings a ControlInputBench and instantiates
// ControlInputContract with it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/control_input.h"
#include "tests/contract/contract_case.h"
#include "tests/support/allocation_counter.h"

namespace octascope::tests {

// A pedal with a knob and somebody who moves them. A fresh bench has a closed device that is
// plugged in, with nothing pressed.
class ControlInputBench {
public:
  virtual ~ControlInputBench() = default;
  virtual hal::ControlInput& input() = 0;
  virtual hal::Clock& clock() = 0;
  virtual bool time_is_exact() const { return false; } // time moves only by sleeping

  virtual int switches() const = 0; // at least 2
  // Now. A bouncing one opens and closes several times within 4 ms before it rests.
  virtual void set_switch(int index, bool pressed) = 0;
  virtual bool can_bounce() const { return false; }
  virtual void make_bouncing() {}
  virtual void turn_knob(int detents) = 0;

  virtual bool has_axes() const { return false; }
  virtual void push_axis(int, int) {} // its index, and how far: −1000…1000

  virtual bool can_unplug() const { return false; }
  virtual void unplug() {}
  virtual void replug() {}
};

using ControlInputCase = ContractCase<ControlInputBench>;

class ControlInputContract : public testing::TestWithParam<ControlInputCase> {
protected:
  struct Move {
    hal::ControlKind kind;
    int index;
    int value;
    bool operator==(const Move&) const = default;
  };
  static constexpr auto pedal = hal::ControlKind::pedal_switch;
  static constexpr auto knob = hal::ControlKind::knob;

  // Everything until nothing has happened for 50 ms, `at_once` at a time; checks the times.
  std::vector<Move> read_all(std::size_t at_once = 16) {
    std::vector<hal::ControlEvent> events(at_once);
    std::vector<Move> moves;
    while (true) {
      const auto n = input_.read(events, std::chrono::milliseconds{50});
      EXPECT_TRUE(n) << (n ? "" : n.error().message);
      if (!n || *n == 0)
        return moves;
      EXPECT_LE(*n, at_once);
      for (const hal::ControlEvent& event : std::span{events}.first(*n)) {
        EXPECT_GE(event.time, last_time_) << "times never decrease";
        EXPECT_LE(event.time, clock_.now());
        last_time_ = event.time;
        moves.push_back({event.kind, event.index, event.value});
      }
    }
  }

  std::unique_ptr<ControlInputBench> bench_ = GetParam().make();
  hal::ControlInput& input_ = bench_->input();
  hal::Clock& clock_ = bench_->clock();
  hal::TimePoint last_time_ = clock_.now();
  std::array<hal::ControlEvent, 16> buffer_{};
};

inline void PrintTo(const hal::ControlKind& kind, std::ostream* out) {
  *out << static_cast<int>(kind);
}

TEST_P(ControlInputContract, walks_through_its_states) {
  EXPECT_FALSE(input_.backend().empty());
  EXPECT_EQ(input_.state(), hal::DeviceState::absent);
  input_.close();
  ASSERT_TRUE(input_.open());
  EXPECT_EQ(input_.state(), hal::DeviceState::ready);
  input_.close();
  EXPECT_EQ(input_.state(), hal::DeviceState::absent);
  ASSERT_TRUE(input_.open()) << "and again";
}

TEST_P(ControlInputContract, refuses_calls_in_the_wrong_order) {
  expect_fault(input_.read(buffer_, {}), hal::ErrorCode::invalid_argument);
  ASSERT_TRUE(input_.open());
  expect_fault(input_.open(), hal::ErrorCode::invalid_argument);
  EXPECT_EQ(input_.state(), hal::DeviceState::ready);
  input_.close();
  expect_fault(input_.read(buffer_, {}), hal::ErrorCode::invalid_argument);
}

TEST_P(ControlInputContract, when_nothing_happens_the_wait_is_kept) {
  ASSERT_TRUE(input_.open());
  const hal::TimePoint before = clock_.now();
  const hal::Duration timeout = std::chrono::milliseconds{20};
  EXPECT_EQ(input_.read(buffer_, timeout).value(), 0U);
  EXPECT_GE(clock_.now() - before, timeout);
  if (bench_->time_is_exact()) {
    EXPECT_EQ(clock_.now() - before, timeout);
  }
  EXPECT_EQ(input_.read(buffer_, {}).value(), 0U);
  EXPECT_EQ(input_.read(buffer_, std::chrono::milliseconds{-1}).value(), 0U);
}

TEST_P(ControlInputContract, each_press_and_release_comes_once_and_in_order) {
  ASSERT_TRUE(input_.open());
  std::vector<Move> expected;
  for (int index = 0; index < bench_->switches(); ++index) {
    for (const bool pressed : {true, false}) {
      bench_->set_switch(index, pressed);
      expected.push_back({pedal, index, pressed});
      EXPECT_EQ(read_all(), std::vector<Move>{expected.back()});
    }
  }
}

TEST_P(ControlInputContract, two_switches_are_independent) {
  ASSERT_TRUE(input_.open());
  bench_->set_switch(0, true);
  EXPECT_EQ(read_all(), (std::vector<Move>{{pedal, 0, 1}}));
  bench_->set_switch(1, true);
  EXPECT_EQ(read_all(), (std::vector<Move>{{pedal, 1, 1}}));
  bench_->set_switch(0, false);
  EXPECT_EQ(read_all(), (std::vector<Move>{{pedal, 0, 0}}));
}

TEST_P(ControlInputContract, the_knob_tells_detents_with_their_sign) {
  ASSERT_TRUE(input_.open());
  int turned = 0;
  for (const int detents : {1, -1, 3, -5})
    bench_->turn_knob(detents);
  for (const Move& move : read_all()) {
    EXPECT_EQ(move.kind, knob);
    turned += move.value;
  }
  EXPECT_EQ(turned, -2) << "a device may merge turns, but loses none";
}

TEST_P(ControlInputContract, a_small_buffer_gets_the_oldest_and_the_rest_stays) {
  ASSERT_TRUE(input_.open());
  for (int index = 0; index < 2; ++index) {
    bench_->set_switch(index, true);
    clock_.sleep_for(std::chrono::milliseconds{20});
  }
  EXPECT_EQ(input_.read({}, std::chrono::milliseconds{1}).value(), 0U);
  EXPECT_EQ(read_all(1), (std::vector<Move>{{pedal, 0, 1}, {pedal, 1, 1}}));
}

TEST_P(ControlInputContract, bounce_is_removed) {
  if (!bench_->can_bounce())
    GTEST_SKIP() << "this bench has only good contacts";
  ASSERT_TRUE(input_.open());
  bench_->make_bouncing();
  for (const bool pressed : {true, false, true, false}) {
    bench_->set_switch(1, pressed);
    EXPECT_EQ(read_all(), (std::vector<Move>{{pedal, 1, pressed}}));
  }
}

TEST_P(ControlInputContract, an_unplugged_press_is_released_first_and_then_told) {
  if (!bench_->can_unplug())
    GTEST_SKIP() << "this bench cannot unplug its device";
  ASSERT_TRUE(input_.open());
  bench_->set_switch(0, true);
  bench_->set_switch(1, true);
  EXPECT_EQ(read_all().size(), 2U);
  bench_->unplug();
  for (int release = 0; release < 2; ++release) { // one at a time
    const auto n = input_.read(std::span{buffer_}.first(1), std::chrono::seconds{5});
    ASSERT_TRUE(n) << n.error().message;
    ASSERT_EQ(*n, 1U);
    EXPECT_EQ(buffer_[0].index, release);
    EXPECT_EQ(buffer_[0].value, 0);
  }
  expect_fault(input_.read(buffer_, std::chrono::seconds{5}), hal::ErrorCode::disconnected);
  EXPECT_EQ(input_.state(), hal::DeviceState::failed);
  expect_fault(input_.read(buffer_, {}), hal::ErrorCode::disconnected);
  expect_fault(input_.open(), hal::ErrorCode::invalid_argument);
  input_.close();
  EXPECT_EQ(input_.state(), hal::DeviceState::absent);
  expect_fault(input_.open(), hal::ErrorCode::absent);

  bench_->replug();
  ASSERT_TRUE(input_.open());
  EXPECT_EQ(read_all(), std::vector<Move>{}) << "nothing is left of the life before";
  bench_->set_switch(0, false);
  EXPECT_EQ(read_all(), std::vector<Move>{});
  bench_->set_switch(0, true);
  EXPECT_EQ(read_all(), (std::vector<Move>{{pedal, 0, 1}}));
}

TEST_P(ControlInputContract, an_unplugged_puck_is_centred_first_and_then_told) {
  if (!bench_->can_unplug() || !bench_->has_axes())
    GTEST_SKIP() << "this bench has no puck to unplug";
  ASSERT_TRUE(input_.open());
  bench_->push_axis(5, 700);
  bench_->push_axis(1, -300);
  bench_->push_axis(1, 0);
  bench_->push_axis(0, 20);
  EXPECT_EQ(read_all().size(), 4U);
  bench_->unplug();
  const auto n = input_.read(buffer_, std::chrono::seconds{5});
  ASSERT_TRUE(n) << n.error().message;
  ASSERT_EQ(*n, 2U);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(buffer_[static_cast<std::size_t>(i)].kind, hal::ControlKind::axis);
    EXPECT_EQ(buffer_[static_cast<std::size_t>(i)].index, i * 5);
    EXPECT_EQ(buffer_[static_cast<std::size_t>(i)].value, 0);
  }
  expect_fault(input_.read(buffer_, std::chrono::seconds{5}), hal::ErrorCode::disconnected);
}

TEST_P(ControlInputContract, what_happens_while_closed_is_not_told) {
  ASSERT_TRUE(input_.open());
  input_.close();
  bench_->turn_knob(3);
  ASSERT_TRUE(input_.open());
  EXPECT_EQ(read_all(), std::vector<Move>{});
}

// Once what a system tells of a device that has just come is past.
TEST_P(ControlInputContract, reading_allocates_nothing) {
  ASSERT_TRUE(input_.open());
  bench_->set_switch(0, true);
  EXPECT_EQ(read_all().size(), 1U);
  bench_->set_switch(0, false);
  EXPECT_EQ(read_all().size(), 1U);
  bench_->set_switch(0, true);
  const std::uint64_t before = allocations_of_this_thread();
  const auto n = input_.read(buffer_, std::chrono::seconds{5});
  EXPECT_EQ(allocations_of_this_thread(), before);
  EXPECT_EQ(n.value(), 1U);
}

} // namespace octascope::tests
