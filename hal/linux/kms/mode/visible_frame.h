// The picture without the margins that the monitor cuts off: drawn into a framebuffer of its own,
// copied into the middle of the screen's.
#pragma once

#include <cstdint>

#include "hal/linux/kms/mode/overscan.h"

namespace octascope::hal::linux_backend::kms {

// Threads: bound to the GL context's. The context must be current wherever this is called.
class VisibleFrame {
public:
  // Binds what the picture is drawn into: the screen itself where there are no margins. Black.
  // ErrorCode::system: no framebuffer of that size.
  Result<> create(int screen_width, int screen_height, const Rectangle& part);
  // Before the context goes.
  void destroy();

  // What was drawn is on the screen's framebuffer, and the picture's is bound again.
  void copy_to_screen() const;

  int width() const { return part_.width; }
  int height() const { return part_.height; }

private:
  bool has_margins() const { return framebuffer_ != 0; }

  Rectangle part_;
  int screen_height_ = 0;
  std::uint32_t framebuffer_ = 0;
  std::uint32_t colour_ = 0;
};

} // namespace octascope::hal::linux_backend::kms
