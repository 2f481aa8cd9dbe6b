#include "firmware-host/run/opening_picture.h"

#include <chrono>

#include "firmware-host/version/version.h"
#include "ui/splash.h"

namespace octascope::firmware_host {

using namespace std::chrono_literals;

namespace {

// Less than systemd waits for the service's end (TimeoutStopSec); after that it is started anew.
constexpr hal::Duration patience = 2500ms;
constexpr hal::Duration between_tries = 100ms;

bool open_in_time(hal::Display& display, const hal::DisplayConfig& config, bool may_come_late,
                  hal::Clock& clock) {
  const hal::TimePoint limit = clock.now() + patience;
  for (;;) {
    const auto opened = display.open(config);
    if (opened)
      return true;
    if (opened.error().code != hal::ErrorCode::absent || !may_come_late ||
        clock.now() + between_tries > limit)
      return false;
    clock.sleep_until(clock.now() + between_tries);
  }
}

} // namespace

void show_opening_picture(hal::Display& display, const hal::DisplayConfig& config,
                          bool may_come_late, hal::Clock& clock) {
  if (!open_in_time(display, config, may_come_late, clock))
    return;
  if (!ui::draw_splash(display.width(), display.height(), version(), "starting") ||
      !display.present())
    display.close();
}

} // namespace octascope::firmware_host
