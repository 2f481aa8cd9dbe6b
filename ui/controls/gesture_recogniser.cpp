#include "ui/controls/gesture_recogniser.h"

#include <algorithm>
#include <bit>

namespace octascope::ui {

namespace {

bool contains(SwitchSet whole, SwitchSet part) {
  return (whole & part) == part;
}

} // namespace

hal::Duration hold_interval(hal::Duration every, int n) {
  constexpr int quickening = 20; // repetitions until it is as fast as it gets
  constexpr int most_percent_off = 60;
  return every * (100 - most_percent_off * std::clamp(n, 0, quickening) / quickening) / 100;
}

GestureRecogniser::GestureRecogniser(std::vector<SwitchBinding> bindings, GestureTimes times)
    : bindings_{std::move(bindings)}, times_{times} {}

const SwitchBinding* GestureRecogniser::bound(SwitchSet switches) const {
  const auto found = std::ranges::find(bindings_, switches, &SwitchBinding::switches);
  return found == bindings_.end() ? nullptr : &*found;
}

// Is more bound than these, with these among it?
bool GestureRecogniser::may_grow(SwitchSet switches) const {
  return std::ranges::any_of(bindings_, [&](const SwitchBinding& b) {
    return b.switches != switches && contains(b.switches, switches);
  });
}

GestureRecogniser::Stroke* GestureRecogniser::stroke_of(SwitchSet some) {
  for (Stroke& stroke : strokes_)
    if (stroke.phase != Phase::free && (stroke.switches & some) != 0)
      return &stroke;
  return nullptr;
}

// Each stroke has a switch of its own, so there is always a free one.
GestureRecogniser::Stroke& GestureRecogniser::new_stroke(SwitchSet switches, hal::TimePoint began) {
  Stroke& stroke = *std::ranges::find(strokes_, Phase::free, &Stroke::phase);
  stroke = {Phase::down, switches, began, {}, std::nullopt, 0};
  return stroke;
}

void GestureRecogniser::wait(Stroke& stroke, Phase phase, std::optional<hal::TimePoint> deadline) {
  stroke.phase = phase;
  stroke.deadline = deadline;
}

void GestureRecogniser::tell(Stroke& stroke, GestureKind kind, hal::TimePoint time,
                             std::vector<Gesture>& told) {
  told.push_back({time, kind, stroke.switches});
  wait(stroke, Phase::spent, std::nullopt);
}

void GestureRecogniser::handle(std::uint8_t switch_index, bool down, hal::TimePoint time,
                               std::vector<Gesture>& told) {
  advance(time, told);
  if (!held_.note(switch_index, down, last_))
    return;
  const SwitchSet one = SwitchSet{1} << switch_index;
  if (down)
    go_down(one, told);
  else
    go_up(one, told);
}

void GestureRecogniser::go_down(SwitchSet one, std::vector<Gesture>& told) {
  if (Stroke* again = stroke_of(one)) { // only one that was let go once is still known
    tell(*again, GestureKind::double_press, last_, told);
    return;
  }
  for (Stroke& stroke : strokes_) {
    const SwitchSet joined = stroke.switches | one;
    if (stroke.phase != Phase::gathering || !(bound(joined) != nullptr || may_grow(joined)))
      continue;
    stroke.switches = joined;
    if (!may_grow(joined))
      settle(stroke, told);
    return;
  }
  Stroke& stroke = new_stroke(one, last_);
  if (may_grow(one))
    wait(stroke, Phase::gathering, last_ + times_.chord);
  else
    settle(stroke, told);
}

// It is clear which switches belong together.
void GestureRecogniser::settle(Stroke& stroke, std::vector<Gesture>& told) {
  const SwitchBinding* found = bound(stroke.switches);
  if (found == nullptr && !std::has_single_bit(stroke.switches)) {
    split(stroke, told);
    return;
  }
  wait(stroke, found == nullptr ? Phase::spent : Phase::down, std::nullopt);
  if (found == nullptr)
    return;
  const SwitchBinding b = stroke.binding = *found;
  const bool alone = !b.long_press && !b.double_press && !b.modifies;
  if (b.hold) {
    if (alone && !b.press)
      tell(stroke, GestureKind::hold, last_, told);
    wait(stroke, alone && !b.press ? Phase::holding : Phase::down,
         stroke.began + times_.hold_delay);
  } else if (b.long_press && !b.modifies) {
    wait(stroke, Phase::down, stroke.began + times_.long_press);
  } else if (b.press && alone) {
    tell(stroke, GestureKind::press, last_, told);
  }
}

// They went down together, but mean nothing together.
void GestureRecogniser::split(Stroke& stroke, std::vector<Gesture>& told) {
  SwitchSet rest = stroke.switches;
  stroke = {};
  while (rest != 0) {
    auto first = static_cast<std::size_t>(std::countr_zero(rest));
    for (std::size_t i = first; i < most_switches; ++i)
      if ((rest >> i & 1U) != 0 && held_.since(i) < held_.since(first))
        first = i;
    const SwitchSet one = SwitchSet{1} << first;
    rest &= ~one;
    settle(new_stroke(one, held_.since(first)), told);
  }
}

void GestureRecogniser::go_up(SwitchSet one, std::vector<Gesture>& told) {
  Stroke* stroke = stroke_of(one);
  if (stroke != nullptr && stroke->phase == Phase::gathering) {
    settle(*stroke, told);
    stroke = stroke_of(one); // another one, if that was split
  }
  if (stroke == nullptr)
    return;
  if (stroke->phase == Phase::down)
    let_go(*stroke, told);
  else if (stroke->phase == Phase::holding)
    wait(*stroke, Phase::spent, std::nullopt);
  if (stroke->phase != Phase::spent)
    return;
  stroke->switches &= ~one;
  if (stroke->switches == 0)
    *stroke = {};
}

void GestureRecogniser::let_go(Stroke& stroke, std::vector<Gesture>& told) {
  const SwitchBinding& b = stroke.binding;
  if (b.long_press && last_ - stroke.began >= times_.long_press)
    tell(stroke, GestureKind::long_press, last_, told);
  else if (b.double_press)
    wait(stroke, Phase::between, last_ + times_.double_press);
  else
    tell_tap(stroke, last_, told);
}

// A short one means one step where no press but repetition is bound.
void GestureRecogniser::tell_tap(Stroke& stroke, hal::TimePoint time, std::vector<Gesture>& told) {
  const SwitchBinding& b = stroke.binding;
  if (b.press || b.hold)
    tell(stroke, b.press ? GestureKind::press : GestureKind::hold, time, told);
  else
    wait(stroke, Phase::spent, std::nullopt);
}

void GestureRecogniser::pass_deadline(Stroke& stroke, std::vector<Gesture>& told) {
  const hal::TimePoint time = *stroke.deadline;
  switch (stroke.phase) {
  case Phase::gathering: settle(stroke, told); break;
  case Phase::down:
  case Phase::holding:
    if (!stroke.binding.hold) {
      tell(stroke, GestureKind::long_press, time, told);
      break;
    }
    tell(stroke, GestureKind::hold, time, told);
    wait(stroke, Phase::holding, time + hold_interval(times_.hold_every, stroke.repetitions++));
    break;
  case Phase::between:
    tell_tap(stroke, time, told);
    stroke = {};
    break;
  case Phase::free:
  case Phase::spent: break;
  }
}

GestureRecogniser::Stroke* GestureRecogniser::earliest() {
  Stroke* first = nullptr;
  for (Stroke& stroke : strokes_)
    if (stroke.deadline && (first == nullptr || *stroke.deadline < *first->deadline))
      first = &stroke;
  return first;
}

void GestureRecogniser::advance(hal::TimePoint now, std::vector<Gesture>& told) {
  const hal::TimePoint end = std::max(now, last_);
  for (Stroke* next = earliest(); next != nullptr && *next->deadline <= end; next = earliest()) {
    last_ = std::max(last_, *next->deadline);
    pass_deadline(*next, told);
  }
  last_ = end;
}

std::optional<hal::TimePoint> GestureRecogniser::next_deadline() const {
  std::optional<hal::TimePoint> first;
  for (const Stroke& stroke : strokes_)
    if (stroke.deadline && (!first || *stroke.deadline < *first))
      first = stroke.deadline;
  return first;
}

SwitchSet GestureRecogniser::modify(hal::TimePoint time, std::vector<Gesture>& told) {
  advance(time, told);
  SwitchSet used = 0;
  for (const SwitchBinding& b : bindings_)
    if (b.modifies && contains(held_.down(), b.switches) &&
        std::popcount(b.switches) > std::popcount(used))
      used = b.switches;
  for (Stroke& stroke : strokes_)
    if ((stroke.switches & used) != 0)
      wait(stroke, Phase::spent, std::nullopt);
  return used;
}

bool GestureRecogniser::idle() const {
  return held_.down() == 0 && std::ranges::all_of(strokes_, [](const Stroke& stroke) {
           return stroke.phase == Phase::free;
         });
}

} // namespace octascope::ui
