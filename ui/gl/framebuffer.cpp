#include "ui/gl/framebuffer.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <GLES3/gl3.h>

namespace octascope::ui::gl {

void clear_to_black(int width, int height) {
  glViewport(0, 0, width, height);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

void finish() {
  glFinish();
}

pipeline::Image read_framebuffer(int width, int height) {
  pipeline::Image image{width, height, 3};
  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  std::vector<std::uint8_t> rgba(4 * w * h);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (std::size_t y = 0; y < h; ++y) // GL's rows run from the bottom
    for (std::size_t x = 0; x < w; ++x)
      std::copy_n(rgba.data() + 4 * ((h - 1 - y) * w + x), 3,
                  image.pixels.data() + 3 * (y * w + x));
  return image;
}

} // namespace octascope::ui::gl
