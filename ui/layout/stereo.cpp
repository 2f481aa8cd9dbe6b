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
  // Of the smallest pictures a rectangle may lie outside: a pixel of the eye's own half is left.
  const int left = std::min(along(rect.x, width, target.width), target.width - 1);
  const int top = std::min(along(rect.y, height, target.height), target.height - 1);
  const int right = std::min(along(rect.right(), width, target.width), target.width);
  const int bottom = std::min(along(rect.bottom(), height, target.height), target.height);
  return {target.x + left, target.y + top, std::max(1, right - left), std::max(1, bottom - top)};
}

EyeFrame eye_frame(StereoMode mode, StereoEye eye, int width, int height) {
  EyeFrame frame{{0, 0, width, height}, width, height};
  const bool second = eye == StereoEye::right;
  if (mode == StereoMode::side_by_side) {
    frame.target.width = std::max(1, width / 2);
    frame.target.x = second ? std::min(frame.target.width, width - frame.target.width) : 0;
  }
  if (mode == StereoMode::top_bottom) {
    frame.target.height = std::max(1, height / 2);
    frame.target.y = second ? std::min(frame.target.height, height - frame.target.height) : 0;
  }
  return frame;
}

} // namespace octascope::ui
