// The image without the margins that the monitor cuts off: drawn into its own framebuffer, then
// copied to the visible part of the screen's.
#pragma once

#include <cstdint>

#include "hal/linux/kms/mode/overscan.h"

namespace octascope::hal::linux_backend::kms {

// Threads: the one where the GL context is current.
class VisibleFrame {
public:
  // Binds the framebuffer to draw into, cleared to black: the screen's if there are no margins.
  // ErrorCode::system: no framebuffer of that size.
  Result<> create(int screen_width, int screen_height, const Rectangle& part);
  // Call it before the context is destroyed.
  void destroy();

  // Copies what was drawn to the screen's framebuffer, and binds the image's again.
  void copy_to_screen() const;

  int width() const { return part_.width; }
  int height() const { return part_.height; }

  // Whether what is drawn into is another framebuffer than the screen's.
  bool has_margins() const { return framebuffer_ != 0; }

private:
  Rectangle part_;
  int screen_height_ = 0;
  std::uint32_t framebuffer_ = 0;
  std::uint32_t colour_ = 0;
};

} // namespace octascope::hal::linux_backend::kms
