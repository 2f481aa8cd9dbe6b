// What the control input's twin does beyond the contract: scripts, contacts, faults, many hands.
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/devices/sim_control_input.h"
#include "tests/sim/twin_support.h"
#include "tests/support/fails_with.h"

namespace octascope::sim {
namespace {

using hal::ControlEvent;
using hal::ControlKind;
using hal::TimePoint;
using namespace std::chrono_literals;
using testing::ElementsAre;

constexpr auto pedal = ControlKind::pedal_switch;

ControlScript script(std::string_view text) {
  auto parsed = ControlScript::parse(text, "hands.toml");
  EXPECT_TRUE(parsed) << (parsed ? "" : parsed.error().message);
  return parsed.value_or(ControlScript{});
}

std::vector<ControlEvent> read_for(SimControlInput& input, hal::Clock& clock,
                                   hal::Duration duration) {
  std::vector<ControlEvent> all;
  std::array<ControlEvent, 4> events;
  for (const TimePoint end = clock.now() + duration; clock.now() < end;) {
    const auto n = input.read(events, end - clock.now());
    EXPECT_TRUE(n) << (n ? "" : n.error().message);
    if (!n)
      return all;
    all.insert(all.end(), events.begin(), events.begin() + static_cast<std::ptrdiff_t>(*n));
  }
  return all;
}

constexpr std::string_view press_and_turn = "[[event]]\ntime_s = 0.2\nknob = 0\nvalue = -3\n"
                                            "[[event]]\ntime_s = 0.1\nswitch = 1\nvalue = 1\n"
                                            "[[event]]\ntime_s = 0.3\nswitch = 1\nvalue = 0\n"
                                            "[[event]]\ntime_s = 0.3\naxis = 4\nvalue = 250\n";

TEST(ControlScript, refuses_what_no_hand_can_do) {
  const std::vector<std::pair<std::string, std::string>> refused{
      {"[[event]]\ntime_s = 1\nvalue = 1", "names 0 controls, expected exactly one"},
      {"[[event]]\ntime_s = 1\nvalue = 1\nswitch = 0\nknob = 0", "names 2 controls"},
      {"[[event]]\ntime_s = 1\nswitch = 0", "value is missing"},
      {"[[event]]\ntime_s = 1\nswitch = 3\nvalue = 1", "switch is 3"},
      {"[[event]]\ntime_s = 1\nswitch = 0\nvalue = 2", "value is 2"},
      {"[[event]]\ntime_s = 1\naxis = 0\nvalue = 1001", "value is 1001"},
      {"[[event]]\ntime_s = -1\nknob = 0\nvalue = 1", "time_s is -1"},
      {"repeat_s = 1\n[[event]]\ntime_s = 1\nknob = 0\nvalue = 1",
       "repeat_s is 1, expected more than"}};
  for (const auto& [text, told] : refused)
    EXPECT_THAT(ControlScript::parse(text, "hands.toml"), tests::FailsSaying(told)) << text;
}

TEST(SimControlInput, plays_its_script_at_its_times_and_again) {
  VirtualClock clock;
  SimControlInput input{clock, script("repeat_s = 1\n" + std::string{press_and_turn})};
  ASSERT_TRUE(input.open());
  const TimePoint t = clock.now();
  const auto events = read_for(input, clock, 2s);
  const auto round = [&](hal::Duration at) {
    return std::vector<ControlEvent>{{t + at + 100ms, pedal, 1, 1},
                                     {t + at + 200ms, ControlKind::knob, 0, -3},
                                     {t + at + 300ms, ControlKind::axis, 4, 250},
                                     {t + at + 300ms, pedal, 1, 0}};
  };
  auto expected = round(0s);
  for (const ControlEvent& event : round(1s))
    expected.push_back(event);
  EXPECT_EQ(events, expected);
}

TEST(SimControlInput, tells_the_same_however_late_it_is_asked) {
  const auto played = [](hal::Duration nap) {
    VirtualClock clock;
    SimControlInput input{clock, script("repeat_s = 1\n" + std::string{press_and_turn})};
    EXPECT_TRUE(input.open());
    clock.sleep_for(nap);
    return read_for(input, clock, 100s + 1ns - nap);
  };
  const auto punctual = played(0s);
  EXPECT_EQ(punctual.size(), 400U);
  EXPECT_EQ(played(100s), punctual);
}

TEST(SimControlInput, a_press_is_told_when_it_has_rested_and_stamped_when_it_came_to_rest) {
  VirtualClock clock;
  FaultSchedule schedule{script_of("[[fault]]\ndevice = \"control_input\"\nkind = \"bounce\"\n"
                                   "at_s = 0\nduration_s = 10\nbounces = 2\nbounce_ms = 4\n")};
  schedule.start(clock.now());
  SimControlInput input{clock, script("[[event]]\ntime_s = 0.1\nswitch = 0\nvalue = 1\n"),
                        &schedule};
  ASSERT_TRUE(input.open());
  const TimePoint t = clock.now();
  std::array<ControlEvent, 4> events;
  ASSERT_EQ(input.read(events, 1s).value(), 1U);
  EXPECT_EQ(events[0].time, t + 104ms);
  EXPECT_EQ(clock.now(), t + 109ms);
  EXPECT_EQ(input.read(events, 1s).value(), 0U);
}

TEST(SimControlInput, times_do_not_decrease_when_the_knob_turns_before_a_press_has_rested) {
  VirtualClock clock;
  SimControlInput input{clock, script("[[event]]\ntime_s = 0.100\nswitch = 0\nvalue = 1\n"
                                      "[[event]]\ntime_s = 0.102\nknob = 0\nvalue = 1\n")};
  ASSERT_TRUE(input.open());
  const TimePoint t = clock.now();
  EXPECT_THAT(read_for(input, clock, 1s),
              ElementsAre(ControlEvent{t + 102ms, ControlKind::knob, 0, 1},
                          ControlEvent{t + 102ms, pedal, 0, 1}));
}

TEST(SimControlInput, a_stuck_switch_ignores_the_foot_until_it_comes_loose) {
  VirtualClock clock;
  FaultSchedule schedule{
      script_of("[[fault]]\ndevice = \"control_input\"\nkind = \"stuck_switch\"\nat_s = 0.05\n"
                "duration_s = 0.2\nswitch = 1\n"
                "[[fault]]\ndevice = \"control_input\"\nkind = \"stuck_switch\"\nat_s = 0.05\n"
                "duration_s = 0.4\nswitch = 2\n")};
  schedule.start(clock.now());
  SimControlInput input{clock,
                        script("[[event]]\ntime_s = 0.1\nswitch = 1\nvalue = 1\n"
                               "[[event]]\ntime_s = 0.2\nswitch = 1\nvalue = 0\n"),
                        &schedule};
  ASSERT_TRUE(input.open());
  const TimePoint t = clock.now();
  EXPECT_THAT(read_for(input, clock, 1s),
              ElementsAre(ControlEvent{t + 50ms, pedal, 1, 1}, ControlEvent{t + 50ms, pedal, 2, 1},
                          ControlEvent{t + 250ms, pedal, 1, 0},
                          ControlEvent{t + 450ms, pedal, 2, 0}));
}

TEST(SimControlInput, unplugged_in_the_middle_of_a_press_at_the_scripted_time) {
  VirtualClock clock;
  FaultSchedule schedule{script_of("[[fault]]\ndevice = \"control_input\"\nkind = \"unplug\"\n"
                                   "at_s = 0.2\nduration_s = 0.5\n")};
  schedule.start(clock.now());
  SimControlInput input{clock,
                        script("repeat_s = 1\n[[event]]\ntime_s = 0.1\nswitch = 0\nvalue = 1\n"
                               "[[event]]\ntime_s = 0.3\nswitch = 0\nvalue = 0\n"),
                        &schedule};
  ASSERT_TRUE(input.open());
  const TimePoint t = clock.now();
  clock.advance(800ms); // plugged in again long ago
  std::array<ControlEvent, 8> events;
  ASSERT_EQ(input.read(events, {}).value(), 2U);
  EXPECT_EQ(events[0], (ControlEvent{t + 100ms, pedal, 0, 1}));
  EXPECT_EQ(events[1], (ControlEvent{t + 200ms, pedal, 0, 0}));
  const auto gone = input.read(events, {});
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, hal::ErrorCode::disconnected);
  input.close();
  ASSERT_TRUE(input.open());
  EXPECT_THAT(read_for(input, clock, 400ms), ElementsAre(ControlEvent{t + 1100ms, pedal, 0, 1}))
      << "the script went on meanwhile";
}

TEST(SimControlInput, refuses_to_be_moved_where_it_has_no_control) {
  VirtualClock clock;
  SimControlInput input{clock};
  EXPECT_FALSE(input.inject({clock.now(), pedal, 3, 1}));
  EXPECT_FALSE(input.inject({clock.now(), pedal, 0, 2}));
  EXPECT_FALSE(input.inject({clock.now(), ControlKind::knob, 1, 1}));
  EXPECT_FALSE(input.inject({clock.now(), ControlKind::axis, 6, 1}));
  EXPECT_FALSE(input.inject({clock.now(), ControlKind::axis, 0, -1001}));
  for (std::size_t i = 0; i < ControlQueue::capacity; ++i)
    EXPECT_TRUE(input.inject({clock.now(), ControlKind::knob, 0, 1}));
  EXPECT_FALSE(input.inject({clock.now(), ControlKind::knob, 0, 1})) << "full";
}

TEST(SimControlInput, many_threads_may_inject_while_one_reads) {
  hal::linux_backend::MonotonicClock clock;
  SimControlInput input{clock};
  ASSERT_TRUE(input.open());
  constexpr int hands = 3;
  constexpr int turns = 2000;
  std::vector<std::thread> threads;
  for (int hand = 0; hand < hands; ++hand) {
    threads.emplace_back([&, hand] {
      for (int i = 0; i < turns; ++i) {
        // Each hand has an axis and counts on it.
        const ControlEvent event{clock.now(), ControlKind::axis, static_cast<std::uint8_t>(hand),
                                 i % 1000};
        while (!input.inject(event))
          std::this_thread::yield();
      }
    });
  }
  std::array<int, hands> next{};
  std::array<ControlEvent, 16> events;
  TimePoint last{};
  for (int received = 0; received < hands * turns;) {
    const auto n = input.read(events, 5s);
    ASSERT_TRUE(n);
    for (const ControlEvent& event : std::span{events}.first(*n)) {
      ASSERT_EQ(event.value, next[event.index]++ % 1000) << "nothing lost, nothing out of order";
      ASSERT_GE(event.time, last);
      last = event.time;
    }
    received += static_cast<int>(*n);
  }
  for (std::thread& thread : threads)
    thread.join();
}

} // namespace
} // namespace octascope::sim
