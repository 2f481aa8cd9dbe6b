#include "hal/display.h"

namespace octascope::hal {

Result<> Display::open(const DisplayConfig& config) {
  if (state() != DeviceState::absent)
    return fail(ErrorCode::busy, "{} display: open already; close() it first", backend());
  if (config.width < 1 || config.height < 1)
    return fail(ErrorCode::invalid_argument, "{} display: size is {}x{}, expected at least 1x1",
                backend(), config.width, config.height);
  if (!(config.refresh_hz >= 1 && config.refresh_hz <= 1000))
    return fail(ErrorCode::invalid_argument, "{} display: refresh_hz is {}, expected 1 to 1000",
                backend(), config.refresh_hz);
  return do_open(config);
}

} // namespace octascope::hal
