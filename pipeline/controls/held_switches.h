// Which pedal switches are down for longer than a foot would hold them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hal/clock.h"
#include "hal/control_input.h"

namespace octascope::pipeline {

// Pure logic, one thread. Knows the first eight switches of a device.
class HeldSwitches {
public:
  static constexpr hal::Duration limit = std::chrono::seconds{4};

  void note(const hal::ControlEvent& event) {
    if (event.kind != hal::ControlKind::pedal_switch || event.index >= since_.size())
      return;
    since_[event.index] = event.value != 0 ? std::optional{event.time} : std::nullopt;
  }

  // The switch that went down first of those that are down for `limit` and were not told yet; each
  // is told once a press.
  std::optional<std::size_t> longest_untold(hal::TimePoint now) {
    std::optional<std::size_t> longest;
    for (std::size_t i = 0; i < since_.size(); ++i) {
      if (since_[i] && now - *since_[i] >= limit && (!longest || *since_[i] < *since_[*longest]))
        longest = i;
    }
    if (longest)
      since_[*longest].reset();
    return longest;
  }

private:
  std::array<std::optional<hal::TimePoint>, 8> since_; // down, and not told yet
};

} // namespace octascope::pipeline
