// How finely the volume is drawn: what the governor turns.
#pragma once

namespace octascope::ui {

struct DrawQuality {
  float resolution = 1; // of the volume's picture, per display pixel and axis
  int steps = 256;      // samples along the longest edge of the volume's box; planes of a stack
                        // are as far apart
  bool operator==(const DrawQuality&) const = default;
};

inline constexpr DrawQuality full_quality{1, 512};

} // namespace octascope::ui
