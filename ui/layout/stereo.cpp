#include "ui/layout/stereo.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace octascope::ui {

std::span<const StereoEye> eyes_of(StereoMode mode) {
  static constexpr std::array one{StereoEye::centre};
  static constexpr std::array two{StereoEye::left, StereoEye::right};
  return mode == StereoMode::off ? std::span<const StereoEye>{one}
                                 : std::span<const StereoEye>{two};
}

Rect EyeFrame::place(const Rect& rect) const {
  const auto along = [](int at, int from, int to) {
    return static_cast<int>(std::int64_t{at} * to / from);
  };
  const int left = along(rect.x, width, target.width);
  const int top = along(rect.y, height, target.height);
  return {target.x + left, target.y + top,
          std::max(1, along(rect.right(), width, target.width) - left),
          std::max(1, along(rect.bottom(), height, target.height) - top)};
}

EyeFrame eye_frame(StereoMode mode, StereoEye eye, int width, int height) {
  EyeFrame frame{{0, 0, width, height}, width, height};
  const bool second = eye == StereoEye::right;
  if (mode == StereoMode::side_by_side) {
    frame.target.width = std::max(1, width / 2);
    frame.target.x = second ? frame.target.width : 0;
  }
  if (mode == StereoMode::top_bottom) {
    frame.target.height = std::max(1, height / 2);
    frame.target.y = second ? frame.target.height : 0;
  }
  return frame;
}

} // namespace octascope::ui
