// Recognises gestures from the times at which switches go down and up: press, long press, double
// press, hold (which repeats), chord, and a switch held while a knob turns.
//
// A gesture is reported at the earliest moment at which it cannot become another one that is bound.
// If these are bound to the switch:
//
//   only a press                   when the switch goes down
//   a chord that it is part of     when the chord is complete, or after 80 ms
//   a long press too               press: on release; long press: after 600 ms
//   a knob while it is held, too   press and long press: on release
//   a double press too             press: 300 ms after release; double: when it goes down again
//   hold                           first at once if nothing else is bound, else after 400 ms;
//                                  then every 100 ms, gradually faster
//
// Pure: no clock. All times are the caller's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "pipeline/controls/held_switches.h"

namespace octascope::ui {

using pipeline::most_switches;
using pipeline::SwitchSet;

enum class GestureKind : std::uint8_t { press, long_press, double_press, hold };

struct GestureTimes {
  hal::Duration chord = std::chrono::milliseconds{80};         // within which all must go down
  hal::Duration long_press = std::chrono::milliseconds{600};   // minimum time down
  hal::Duration double_press = std::chrono::milliseconds{300}; // from up to down
  hal::Duration hold_delay = std::chrono::milliseconds{400};
  hal::Duration hold_every = std::chrono::milliseconds{100};
};

// The gestures bound to one set of switches. Sets of several switches can have only `press` and
// `modifies`.
struct SwitchBinding {
  SwitchSet switches = 0;
  bool press = false;
  bool long_press = false;
  bool double_press = false;
  bool hold = false;     // not together with long_press or modifies
  bool modifies = false; // a knob turned meanwhile has another meaning
};

struct Gesture {
  hal::TimePoint time; // when it was certain, not when advance() found it
  GestureKind kind = GestureKind::press;
  SwitchSet switches = 0;
  bool operator==(const Gesture&) const = default;
};

// The time from one repetition to the next, the n-th (from 0): `every` at first, shortening to 40 %
// of it. Pure.
hal::Duration hold_interval(hal::Duration every, int n);

// Threads: one at a time. Gestures are appended to `told`, oldest first. A time earlier than the
// last one is taken as the last one. A gesture that is not bound is never reported.
class GestureRecogniser {
public:
  // At most one entry per set.
  GestureRecogniser(std::vector<SwitchBinding> bindings, GestureTimes times);

  // A switch went down or up. Repeating its state changes nothing.
  void handle(std::uint8_t switch_index, bool down, hal::TimePoint time,
              std::vector<Gesture>& told);

  // Reports the gestures decided by time alone, up to `now`.
  void advance(hal::TimePoint now, std::vector<Gesture>& told);

  // When advance() will next report something if no switch moves.
  std::optional<hal::TimePoint> next_deadline() const;

  // A knob turns. Returns the held switches that modify it, 0 for none. These then report no
  // gesture of their own until released.
  SwitchSet modify(hal::TimePoint time, std::vector<Gesture>& told);

  // Whether no switch is down and no gesture is in progress.
  bool idle() const;

private:
  enum class Phase : std::uint8_t {
    free,      // unused
    gathering, // more switches may join it
    down,      // its switches are known, its gesture is not
    between,   // released once: it may become a double press
    holding,   // repeats
    spent,     // its gesture was reported
  };
  // One set of switches that went down together. Once its gesture was reported, released switches
  // leave the set.
  struct Stroke {
    Phase phase = Phase::free;
    SwitchSet switches = 0;
    hal::TimePoint began;
    SwitchBinding binding;                  // from Phase::down on
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
  std::array<Stroke, most_switches> strokes_{}; // each owns at least one switch, so these suffice
  pipeline::HeldSwitches held_;
  hal::TimePoint last_; // the latest time given
};

} // namespace octascope::ui
