#include "hal/linux/kms/mode/overscan.h"

#include <algorithm>
#include <cmath>

namespace octascope::hal::linux_backend::kms {

Result<Rectangle> visible_part(int width, int height, const Overscan& overscan) {
  for (const double margin : {overscan.left, overscan.right, overscan.top, overscan.bottom})
    if (!(margin >= 0 && margin <= 25))
      return fail(ErrorCode::invalid_argument,
                  "kms display: an overscan margin is {} %, expected 0 to 25", margin);
  const auto pixels = [](int whole, double percent) {
    return static_cast<int>(std::lround(whole * percent / 100));
  };
  const int left = pixels(width, overscan.left);
  const int top = pixels(height, overscan.top);
  return Rectangle{left, top, std::max(width - left - pixels(width, overscan.right), 1),
                   std::max(height - top - pixels(height, overscan.bottom), 1)};
}

} // namespace octascope::hal::linux_backend::kms
