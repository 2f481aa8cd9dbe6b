// Every gesture to the millisecond, with times of our own.
#include <algorithm>
#include <bit>
#include <ostream>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/files/fresh_seed.h"
#include "ui/controls/gesture_recogniser.h"

namespace octascope::ui {

// How a failed test shows one; times count from t0.
void PrintTo(const Gesture& gesture, std::ostream* out) {
  *out << "{" << hal::to_ms(gesture.time.time_since_epoch()) - 100e3 << " ms, kind "
       << static_cast<int>(gesture.kind) << ", switches " << gesture.switches << "}";
}

namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;

constexpr hal::TimePoint t0{100s};
constexpr SwitchSet left = 1;
constexpr SwitchSet centre = 2;
constexpr SwitchSet right = 4;

// Plays moments and collects what is told, with times in ms since t0.
class Foot {
public:
  explicit Foot(std::vector<SwitchBinding> bindings, GestureTimes times = {})
      : recogniser{std::move(bindings), times} {}

  Foot& down(SwitchSet one, int ms) { return move(one, true, ms); }
  Foot& up(SwitchSet one, int ms) { return move(one, false, ms); }
  Foot& wait(int ms) {
    recogniser.advance(t0 + milliseconds{ms}, told);
    return *this;
  }
  SwitchSet turn(int ms) { return recogniser.modify(t0 + milliseconds{ms}, told); }
  // What was told since the last time.
  std::vector<Gesture> heard() { return std::exchange(told, {}); }

  GestureRecogniser recogniser;
  std::vector<Gesture> told;

private:
  Foot& move(SwitchSet one, bool down, int ms) {
    recogniser.handle(static_cast<std::uint8_t>(std::countr_zero(one)), down, t0 + milliseconds{ms},
                      told);
    return *this;
  }
};

using Told = std::vector<Gesture>;
Gesture at(int ms, GestureKind kind, SwitchSet switches) {
  return {t0 + milliseconds{ms}, kind, switches};
}
Gesture press(int ms, SwitchSet switches) {
  return at(ms, GestureKind::press, switches);
}

TEST(GestureRecogniser, a_press_alone_acts_when_the_switch_goes_down) {
  Foot foot{{{.switches = left, .press = true}}};
  EXPECT_EQ(foot.down(left, 10).heard(), Told{press(10, left)});
  EXPECT_EQ(foot.recogniser.next_deadline(), std::nullopt);
  EXPECT_EQ(foot.wait(5000).up(left, 6000).heard(), Told{});
  EXPECT_TRUE(foot.recogniser.idle());
  EXPECT_EQ(foot.down(centre, 7000).up(centre, 7010).heard(), Told{}) << "bound to nothing";
  EXPECT_TRUE(foot.recogniser.idle());
}

TEST(GestureRecogniser, beside_a_long_press_a_press_acts_when_let_go) {
  Foot foot{{{.switches = left, .press = true, .long_press = true}}};
  EXPECT_EQ(foot.down(left, 0).wait(599).heard(), Told{});
  EXPECT_EQ(foot.recogniser.next_deadline(), t0 + 600ms);
  EXPECT_EQ(foot.up(left, 599).heard(), Told{press(599, left)});
  EXPECT_EQ(foot.down(left, 1000).wait(1599).heard(), Told{});
  EXPECT_EQ(foot.wait(1600).heard(), (Told{at(1600, GestureKind::long_press, left)}));
  EXPECT_EQ(foot.up(left, 2000).heard(), Told{}) << "it was long already";
  // Told late, it still has its own time.
  EXPECT_EQ(foot.down(left, 3000).wait(3900).heard(),
            (Told{at(3600, GestureKind::long_press, left)}));
}

TEST(GestureRecogniser, two_presses_are_a_double_within_their_time) {
  Foot foot{{{.switches = left, .press = true, .double_press = true}}};
  EXPECT_EQ(foot.down(left, 0).up(left, 100).wait(399).heard(), Told{});
  EXPECT_EQ(foot.recogniser.next_deadline(), t0 + 400ms);
  EXPECT_EQ(foot.wait(400).heard(), Told{press(400, left)});
  EXPECT_TRUE(foot.recogniser.idle());
  EXPECT_EQ(foot.down(left, 1000).up(left, 1100).down(left, 1399).heard(),
            (Told{at(1399, GestureKind::double_press, left)}))
      << "at once with the second";
  EXPECT_EQ(foot.up(left, 1450).wait(3000).heard(), Told{});
  EXPECT_EQ(foot.down(left, 4000).up(left, 4100).down(left, 4400).up(left, 4450).wait(5000).heard(),
            (Told{press(4400, left), press(4750, left)}))
      << "too late for a double";
}

TEST(GestureRecogniser, press_long_and_double_on_one_switch) {
  Foot foot{{{.switches = left, .press = true, .long_press = true, .double_press = true}}};
  EXPECT_EQ(foot.down(left, 0).up(left, 50).wait(350).heard(), Told{press(350, left)});
  EXPECT_EQ(foot.down(left, 1000).wait(1600).up(left, 1700).wait(3000).heard(),
            (Told{at(1600, GestureKind::long_press, left)}));
  EXPECT_EQ(foot.down(left, 4000).up(left, 4050).down(left, 4100).wait(6000).up(left, 6100).heard(),
            (Told{at(4100, GestureKind::double_press, left)}));
}

TEST(GestureRecogniser, held_repeats_faster_by_and_by) {
  Foot foot{{{.switches = right, .hold = true}}};
  foot.down(right, 0).wait(5000);
  const Told told = foot.heard();
  ASSERT_GT(told.size(), 10U);
  EXPECT_EQ(told[0], at(0, GestureKind::hold, right));
  EXPECT_EQ(told[1], at(400, GestureKind::hold, right));
  EXPECT_EQ(told[2], at(500, GestureKind::hold, right));
  hal::Duration last = 100ms;
  for (std::size_t i = 3; i < told.size(); ++i) {
    const hal::Duration interval = told[i].time - told[i - 1].time;
    EXPECT_LE(interval, last);
    EXPECT_GE(interval, 40ms);
    last = interval;
  }
  EXPECT_EQ(last, 40ms);
  EXPECT_EQ(foot.up(right, 5001).wait(9000).heard(), Told{});
  EXPECT_TRUE(foot.recogniser.idle());
}

TEST(GestureRecogniser, beside_a_hold_a_press_is_a_short_one) {
  Foot foot{{{.switches = left, .press = true, .hold = true}}};
  EXPECT_EQ(foot.down(left, 0).up(left, 399).heard(), Told{press(399, left)});
  EXPECT_EQ(foot.down(left, 1000).wait(1500).up(left, 1510).heard(),
            (Told{at(1400, GestureKind::hold, left), at(1500, GestureKind::hold, left)}));
}

TEST(GestureRecogniser, chord_window_to_the_millisecond) {
  const std::vector<SwitchBinding> bindings{{.switches = left, .press = true},
                                            {.switches = right, .press = true},
                                            {.switches = left | right, .press = true}};
  Foot together{bindings};
  EXPECT_EQ(together.down(left, 0).down(right, 79).heard(), Told{press(79, left | right)});
  EXPECT_EQ(together.up(right, 200).up(left, 900).wait(2000).heard(), Told{});
  EXPECT_TRUE(together.recogniser.idle());
  Foot apart{bindings};
  EXPECT_EQ(apart.down(left, 0).wait(79).heard(), Told{});
  EXPECT_EQ(apart.down(right, 81).wait(161).heard(), (Told{press(80, left), press(161, right)}));
  Foot tap{bindings};
  EXPECT_EQ(tap.down(left, 0).up(left, 30).heard(), Told{press(30, left)})
      << "nothing to wait for once it is up";
}

TEST(GestureRecogniser, of_three_switches_the_largest_chord_wins) {
  const std::vector<SwitchBinding> bindings{{.switches = left, .press = true},
                                            {.switches = left | centre, .press = true},
                                            {.switches = left | centre | right, .press = true}};
  Foot foot{bindings};
  EXPECT_EQ(foot.down(centre, 0).down(left, 20).down(right, 40).heard(),
            Told{press(40, left | centre | right)});
  foot.up(left, 100).up(centre, 110).up(right, 120);
  EXPECT_EQ(foot.down(centre, 1000).down(left, 1020).wait(1080).heard(),
            Told{press(1080, left | centre)});
  foot.up(left, 1100).up(centre, 1110);
  EXPECT_TRUE(foot.recogniser.idle());
  EXPECT_EQ(foot.down(left, 2000).down(right, 2030).wait(2080).heard(), Told{press(2080, left)})
      << "left and right alone mean nothing together";
}

TEST(GestureRecogniser, a_switch_that_lends_the_knob_a_meaning_has_none_of_its_own) {
  Foot foot{{{.switches = left, .press = true, .long_press = true, .modifies = true},
             {.switches = left | right, .modifies = true}}};
  EXPECT_EQ(foot.turn(0), 0U);
  foot.down(left, 100);
  EXPECT_EQ(foot.turn(900), left) << "a hand takes its time to reach the knob";
  EXPECT_EQ(foot.turn(2000), left);
  EXPECT_EQ(foot.up(left, 2100).wait(3000).heard(), Told{});
  EXPECT_EQ(foot.down(left, 4000).up(left, 4599).heard(), Told{press(4599, left)});
  EXPECT_EQ(foot.down(left, 5000).wait(5700).heard(), Told{}) << "it may still turn";
  EXPECT_EQ(foot.up(left, 5700).heard(), (Told{at(5700, GestureKind::long_press, left)}));
  foot.down(left, 7000).down(right, 7500);
  EXPECT_EQ(foot.turn(7600), left | right) << "however late the second went down";
  EXPECT_EQ(foot.up(left, 7700).up(right, 7800).wait(9000).heard(), Told{});
  EXPECT_TRUE(foot.recogniser.idle());
}

TEST(GestureRecogniser, the_same_twice_and_times_that_go_back_change_nothing) {
  Foot foot{{{.switches = left, .press = true, .long_press = true}}};
  foot.down(left, 100).down(left, 200).down(left, 300);
  EXPECT_EQ(foot.wait(700).heard(), (Told{at(700, GestureKind::long_press, left)}));
  EXPECT_EQ(foot.up(left, 650).up(left, 660).heard(), Told{});
  EXPECT_TRUE(foot.recogniser.idle());
  EXPECT_EQ(foot.down(left, 0).up(left, 0).heard(), Told{press(700, left)})
      << "counted as the latest time known";
  foot.recogniser.handle(200, true, t0 + 1s, foot.told);
  EXPECT_TRUE(foot.recogniser.idle()) << "there is no such switch";
}

SwitchBinding random_binding(SwitchSet switches, std::mt19937_64& generator) {
  SwitchBinding b{.switches = switches, .press = generator() % 2 == 0};
  const bool single = std::has_single_bit(switches);
  b.hold = single && generator() % 4 == 0;
  b.modifies = !b.hold && generator() % 3 == 0;
  b.long_press = single && !b.hold && generator() % 2 == 0;
  b.double_press = single && generator() % 3 == 0;
  return b;
}

// Whatever feet do: only what is bound is told, in the order of time for each switch, deadlines lie
// ahead, and once everything is let go nothing stays behind.
TEST(GestureRecogniser, random_feet_leave_no_switch_stuck) {
  std::mt19937_64 generator{tests::fresh_seed()};
  for (int round = 0; round < 400; ++round) {
    std::vector<SwitchBinding> bindings;
    for (SwitchSet set = 1; set < 32; ++set)
      if (generator() % 3 == 0)
        bindings.push_back(random_binding(set, generator));
    GestureRecogniser recogniser{bindings, {}};
    std::vector<Gesture> told;
    hal::TimePoint now = t0;
    for (int i = 0; i < 200; ++i) {
      now += milliseconds{static_cast<int>(generator() % (generator() % 5 == 0 ? 900 : 60))};
      const hal::TimePoint said = generator() % 10 == 0 ? now - 50ms : now;
      switch (generator() % 6) {
      case 0: recogniser.advance(said, told); break;
      case 1: recogniser.modify(said, told); break;
      default:
        recogniser.handle(static_cast<std::uint8_t>(generator() % 5), generator() % 2 == 0, said,
                          told);
      }
      if (const auto deadline = recogniser.next_deadline()) {
        EXPECT_GT(*deadline, said);
      }
    }
    for (const Gesture& gesture : told) {
      const auto bound = std::ranges::find(bindings, gesture.switches, &SwitchBinding::switches);
      ASSERT_NE(bound, bindings.end());
      const bool is_bound = gesture.kind == GestureKind::press          ? bound->press
                            : gesture.kind == GestureKind::long_press   ? bound->long_press
                            : gesture.kind == GestureKind::double_press ? bound->double_press
                                                                        : bound->hold;
      EXPECT_TRUE(is_bound) << testing::PrintToString(gesture);
      EXPECT_LE(gesture.time, now);
    }
    EXPECT_TRUE(std::ranges::is_sorted(told, {}, &Gesture::time));
    for (std::uint8_t i = 0; i < 5; ++i)
      recogniser.handle(i, false, now, told);
    recogniser.advance(now + 10s, told);
    ASSERT_TRUE(recogniser.idle()) << "round " << round;
    ASSERT_EQ(recogniser.next_deadline(), std::nullopt);
    const std::size_t so_far = told.size();
    recogniser.advance(now + 100s, told);
    EXPECT_EQ(told.size(), so_far);
  }
}

} // namespace
} // namespace octascope::ui
