// Tracks which switches of a device are down, since when, and which have been down too long to be
// held by a foot.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/clock.h"
#include "hal/control_input.h"

namespace octascope::pipeline {

// Bit i is switch i.
using SwitchSet = std::uint32_t;
inline constexpr int most_switches = 32;

// Pure logic, one thread: the control thread and the gesture recogniser have one each.
class HeldSwitches {
public:
  static constexpr hal::Duration limit = std::chrono::seconds{4};

  // A switch goes down or up at `time`. False if it was already in that state or `index` is out of
  // range.
  bool note(std::size_t index, bool down, hal::TimePoint time) {
    if (index >= since_.size() || is_down(index) == down)
      return false;
    const SwitchSet one = SwitchSet{1} << index;
    down_ ^= one;
    untold_ = down ? untold_ | one : untold_ & ~one;
    if (down)
      since_[index] = time;
    return true;
  }

  SwitchSet down() const { return down_; }
  bool is_down(std::size_t index) const { return (down_ >> index & 1U) != 0; }
  // When it last went down.
  hal::TimePoint since(std::size_t index) const { return since_[index]; }

  // The switch that has been down longest, if for at least `limit`, among those not reported yet.
  // Reports each press once.
  std::optional<std::size_t> longest_untold(hal::TimePoint now) {
    std::optional<std::size_t> longest;
    for (SwitchSet left = untold_; left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      if (now - since_[i] >= limit && (!longest || since_[i] < since_[*longest]))
        longest = i;
    }
    if (longest)
      untold_ &= ~(SwitchSet{1} << *longest);
    return longest;
  }

private:
  SwitchSet down_ = 0;
  SwitchSet untold_ = 0; // down and not reported yet
  std::array<hal::TimePoint, most_switches> since_{};
};

} // namespace octascope::pipeline
