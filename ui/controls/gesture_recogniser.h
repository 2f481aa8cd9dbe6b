// Tells what a foot means from when switches go down and up: press, long press, double press, held,
// several at once, and a switch held while a knob turns.
//
// A gesture is told at the earliest moment at which it cannot become another one that is bound:
//
//   only a press is bound          when the switch goes down
//   part of a chord that is bound  when the chord is complete, or after 80 ms
//   also long, or holds a knob     when it is let go (a long press: after 600 ms; where the switch
//                                  also holds a knob, when it is let go after them)
//   also double                    300 ms after it is let go; a double when it goes down again
//   held                           its first at once where nothing else is bound, else after 400
//   ms;
//                                  then every 100 ms, faster by and by
//
// Pure: no clock. All times are the caller's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/clock.h"

namespace octascope::ui {

// Bit i is switch i.
using SwitchSet = std::uint32_t;
inline constexpr int most_switches = 32;

enum class GestureKind : std::uint8_t { press, long_press, double_press, hold };

struct GestureTimes {
  hal::Duration chord = std::chrono::milliseconds{80};         // within which all must be down
  hal::Duration long_press = std::chrono::milliseconds{600};   // down for so long
  hal::Duration double_press = std::chrono::milliseconds{300}; // from up to down
  hal::Duration hold_delay = std::chrono::milliseconds{400};
  hal::Duration hold_every = std::chrono::milliseconds{100};
};

// What is bound to one set of switches: to several only press and modifies.
struct SwitchBinding {
  SwitchSet switches = 0;
  bool press = false;
  bool long_press = false;
  bool double_press = false;
  bool hold = false;     // not together with long_press or modifies
  bool modifies = false; // a knob turned meanwhile means something else
};

struct Gesture {
  hal::TimePoint time; // when it was clear, not when it was noticed
  GestureKind kind = GestureKind::press;
  SwitchSet switches = 0;
  bool operator==(const Gesture&) const = default;
};

// The n-th repetition (from 0) follows the one before after so long: `every`, and by and by down to
// 40 % of it. Pure.
hal::Duration hold_interval(hal::Duration every, int n);

// Threads: one at a time. Gestures are appended to `told`, oldest first. A time before the last one
// counts as the last one. What is not bound is never told.
class GestureRecogniser {
public:
  // At most one entry per set.
  GestureRecogniser(std::vector<SwitchBinding> bindings, GestureTimes times);

  // A switch went down or up; telling the same twice changes nothing.
  void handle(std::uint8_t switch_index, bool down, hal::TimePoint time,
              std::vector<Gesture>& told);

  // Tells what time alone decides, up to `now`.
  void advance(hal::TimePoint now, std::vector<Gesture>& told);

  // When advance() will tell something, if nothing happens before.
  std::optional<hal::TimePoint> next_deadline() const;

  // A knob turns: the set of held switches that it is bound with, 0 for none. The switches so used
  // mean nothing else until they are let go.
  SwitchSet modify(hal::TimePoint time, std::vector<Gesture>& told);

  // All switches that are down.
  SwitchSet held() const { return held_; }
  bool idle() const;

private:
  enum class Phase : std::uint8_t {
    free,      // no stroke
    gathering, // more switches may join
    down,      // clear which switches, not yet what they mean
    between,   // let go once, perhaps to go down again
    holding,   // repeats
    spent,     // its meaning was told
  };
  // One set of switches that went down together. Those that came up again are no longer of it, once
  // its meaning was told.
  struct Stroke {
    Phase phase = Phase::free;
    SwitchSet switches = 0;
    hal::TimePoint began;
    SwitchBinding binding;                  // once it is clear which switches they are
    std::optional<hal::TimePoint> deadline; // when its phase ends by itself
    int repetitions = 0;
  };

  const SwitchBinding* bound(SwitchSet switches) const;
  bool may_grow(SwitchSet switches) const;
  Stroke* stroke_of(SwitchSet some);
  Stroke& new_stroke(SwitchSet switches, hal::TimePoint began);
  Stroke* earliest();
  static void wait(Stroke& stroke, Phase phase, std::optional<hal::TimePoint> deadline);
  static void tell(Stroke& stroke, GestureKind kind, hal::TimePoint time,
                   std::vector<Gesture>& told);
  void tell_tap(Stroke& stroke, hal::TimePoint time, std::vector<Gesture>& told);
  void go_down(SwitchSet one, std::vector<Gesture>& told);
  void go_up(SwitchSet one, std::vector<Gesture>& told);
  void settle(Stroke& stroke, std::vector<Gesture>& told);
  void split(Stroke& stroke, std::vector<Gesture>& told);
  void let_go(Stroke& stroke, std::vector<Gesture>& told);
  void pass_deadline(Stroke& stroke, std::vector<Gesture>& told);

  std::vector<SwitchBinding> bindings_;
  GestureTimes times_;
  std::array<Stroke, most_switches> strokes_{}; // each has a switch of its own, so these suffice
  std::array<hal::TimePoint, most_switches> down_since_{};
  SwitchSet held_ = 0;
  hal::TimePoint last_; // the latest time that was told to us
};

} // namespace octascope::ui
