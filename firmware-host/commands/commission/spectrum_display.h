// The live spectrum on the display, beside the terminal.
#pragma once

#include <optional>

#include "firmware-host/commands/commission/live_look.h"
#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/devices/devices.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "ui/spectrum_screen.h"

namespace octascope::firmware_host {

// A window, or the console's output, whichever `run` would choose. Where there is none, or it goes,
// the terminal says so, once, and all goes on without. Bound to one thread; no other GL context may
// be current on it while this is open.
class SpectrumDisplay {
public:
  explicit SpectrumDisplay(hal::Clock& clock) : clock_(clock) {}
  ~SpectrumDisplay() { close(); }
  SpectrumDisplay(const SpectrumDisplay&) = delete;
  SpectrumDisplay& operator=(const SpectrumDisplay&) = delete;

  void open(const RunOptions& options, const Configuration& configuration);
  // Of a look that has lines.
  void show(const LiveLook& found);
  // Whether Enter, Escape or the window's close button asked for the end there.
  bool ended();
  // Releases the display; the next open() takes it again.
  void close();

private:
  hal::Result<> draw(const LiveLook& found);
  void go_on_without(std::string_view why);

  hal::Clock& clock_;
  std::optional<Devices> devices_; // only their display is used
  std::optional<ui::SpectrumScreen> screen_;
  bool told_ = false;
};

} // namespace octascope::firmware_host
