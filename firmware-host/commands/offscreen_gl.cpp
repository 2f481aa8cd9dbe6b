#include "firmware-host/commands/offscreen_gl.h"

namespace octascope::firmware_host {

hal::Result<std::unique_ptr<OffscreenGl>> OffscreenGl::open(int width, int height) {
  std::unique_ptr<OffscreenGl> made{new OffscreenGl};
  hal::DisplayConfig config;
  config.width = width;
  config.height = height;
  HAL_CHECK(made->display_.open(config));
  return made;
}

} // namespace octascope::firmware_host
