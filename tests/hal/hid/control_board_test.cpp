#include <random>

#include <gtest/gtest.h>

#include "hal/linux/hid/controls/control_board.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

using namespace std::chrono_literals;

class ControlBoardTest : public testing::Test {
protected:
  static TimePoint at(Duration t) { return TimePoint{t}; }
  std::vector<ControlEvent> take() {
    std::vector<ControlEvent> events(300);
    events.resize(board_.take(events));
    return events;
  }
  void note(std::size_t port, Duration t, std::uint32_t switches) {
    board_.settle(at(t));
    board_.note(port, {.switches = switches}, at(t));
  }

  ControlBoard board_;
};

constexpr auto pedal = ControlKind::pedal_switch;

TEST_F(ControlBoardTest, the_second_device_follows_the_first) {
  const auto first = board_.add_device(3, 0);
  const auto second = board_.add_device(1, 1);
  const auto a = board_.add_port(*first), b = board_.add_port(*second);
  note(*a, 1ms, 4);
  note(*b, 2ms, 1);
  board_.note(*b, {.knob = -2}, at(2ms));
  board_.settle(at(20ms));
  EXPECT_EQ(take(), (std::vector<ControlEvent>{{at(2ms), ControlKind::knob, 0, -2},
                                               {at(2ms), pedal, 2, 1},
                                               {at(2ms), pedal, 3, 1}}));
}

TEST_F(ControlBoardTest, a_device_is_down_while_any_of_its_files_says_so) {
  const auto device = board_.add_device(1, 0);
  const auto a = board_.add_port(*device), b = board_.add_port(*device);
  note(*a, 0ms, 1);
  note(*b, 10ms, 1);
  note(*a, 20ms, 0);
  note(*b, 30ms, 0);
  board_.settle(at(40ms));
  EXPECT_EQ(take(), (std::vector<ControlEvent>{{at(0ms), pedal, 0, 1}, {at(30ms), pedal, 0, 0}}));
}

TEST_F(ControlBoardTest, everything_is_released_once) {
  const auto port = board_.add_port(*board_.add_device(3, 0));
  note(*port, 0ms, 5);
  board_.note(*port, {.axes_told = 2, .axes = {0, 300}}, at(1ms));
  board_.settle(at(10ms));
  EXPECT_EQ(take().size(), 3U);
  board_.release_all(at(11ms));
  EXPECT_EQ(take(), (std::vector<ControlEvent>{{at(11ms), pedal, 0, 0},
                                               {at(11ms), pedal, 2, 0},
                                               {at(11ms), ControlKind::axis, 1, 0}}));
  board_.release_all(at(12ms));
  EXPECT_TRUE(take().empty());
}

TEST_F(ControlBoardTest, an_axis_that_stays_is_not_told_again) {
  const auto port = board_.add_port(*board_.add_device(0, 0));
  for (int i = 0; i < 3; ++i)
    board_.note(*port, {.axes_told = 3, .axes = {100, 0}}, at(1ms));
  EXPECT_EQ(take(), (std::vector<ControlEvent>{{at(1ms), ControlKind::axis, 0, 100}}));
}

TEST_F(ControlBoardTest, what_is_too_much_stays_out) {
  EXPECT_EQ(board_.place(*board_.add_device(20, 5)).switches, 20);
  const auto second = board_.add_device(20, 5);
  EXPECT_EQ(board_.place(*second).switches, 12);
  EXPECT_EQ(board_.place(*second).knobs, 3);
  const auto third = board_.add_device(5, 1);
  EXPECT_EQ(board_.place(*third).switches, 0);
  const auto port = board_.add_port(*third);
  note(*port, 0ms, 31);
  board_.note(*port, {.knob = 1}, at(0ms));
  board_.settle(at(10ms));
  EXPECT_TRUE(take().empty());
  while (board_.add_device(1, 1)) {
  }
  while (board_.add_port(0)) {
  }
}

// Whatever is done: presses and releases of a switch take turns, times never decrease, the ring
// never overflows, and in the end everything is let go.
TEST_F(ControlBoardTest, keeps_its_promises_under_random_hands) {
  std::mt19937 random{tests::fresh_seed()};
  for (int round = 0; round < 50; ++round) {
    board_.clear();
    std::vector<std::size_t> ports;
    for (int i = 0; i < 4; ++i)
      ports.push_back(*board_.add_port(*board_.add_device(8, 1)));
    std::array<int, most_switches> down{};
    TimePoint last{};
    const auto check = [&](std::size_t most) {
      std::vector<ControlEvent> events(most);
      events.resize(board_.take(events));
      for (const ControlEvent& event : events) {
        ASSERT_GE(event.time, last);
        last = event.time;
        if (event.kind == pedal) {
          ASSERT_NE(event.value, down[event.index]);
          down[event.index] = event.value;
        }
      }
    };
    TimePoint now{1s * (round + 1)};
    for (int i = 0; i < 2000; ++i) {
      now += std::chrono::microseconds{random() % 9000};
      if (board_.has_room()) {
        board_.settle(now);
        board_.note(ports[random() % 4],
                    {.switches = random() & 0xffU,
                     .knob = static_cast<std::int32_t>(random() % 3) - 1,
                     .axes_told = static_cast<std::uint8_t>(random() % 64),
                     .axes = {static_cast<std::int16_t>(random() % 5)}},
                    now);
      }
      if (random() % 4 == 0)
        check(random() % 64);
      ASSERT_FALSE(HasFatalFailure());
    }
    check(300);
    board_.release_all(now);
    check(300);
    for (const int value : down)
      ASSERT_EQ(value, 0);
  }
}

} // namespace
} // namespace octascope::hal::linux_backend
