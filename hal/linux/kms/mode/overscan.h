// The visible part of the screen on a monitor with overscan. Pure.
#pragma once

#include "hal/result.h"

namespace octascope::hal::linux_backend::kms {

// What the monitor cuts off, in per cent of the mode's width or height; each 0 to 25.
struct Overscan {
  double left = 0;
  double right = 0;
  double top = 0;
  double bottom = 0;
};

struct Rectangle {
  int x = 0; // from the left
  int y = 0; // from the top
  int width = 0;
  int height = 0;
  bool operator==(const Rectangle&) const = default;
};

// ErrorCode::invalid_argument: a margin is out of range.
Result<Rectangle> visible_part(int width, int height, const Overscan& overscan);

} // namespace octascope::hal::linux_backend::kms
