// What the display shows from the first moment on, until there is a picture.
#pragma once

#include "hal/clock.h"
#include "hal/display.h"

namespace octascope::firmware_host {

// Finding the faster reconstruction and making the twins' loop take seconds: meanwhile the display
// says what is starting, and stays open. `may_come_late`: one that is absent is waited for,
// shortly, as a service may be started before the graphics driver is loaded or the monitor is
// awake. What fails here fails again, and is told, when the render loop opens the display.
void show_opening_picture(hal::Display& display, const hal::DisplayConfig& config,
                          bool may_come_late, hal::Clock& clock);

} // namespace octascope::firmware_host
