// What the display shows until the first picture.
#pragma once

#include "hal/clock.h"
#include "hal/display.h"

namespace octascope::firmware_host {

// Choosing the reconstruction and making the twins' loop take seconds; meanwhile the display says
// what is starting, and stays open. `may_come_late`: an absent display is waited for briefly, as a
// service may start before the graphics driver is loaded or the monitor is awake. Errors are
// ignored here: they recur, and are reported, when the render loop opens the display.
void show_opening_picture(hal::Display& display, const hal::DisplayConfig& config,
                          bool may_come_late, hal::Clock& clock);

} // namespace octascope::firmware_host
