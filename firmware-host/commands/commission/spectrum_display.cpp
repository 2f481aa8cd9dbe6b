#include "firmware-host/commands/commission/spectrum_display.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "firmware-host/commands/commission/spectrum_text.h"
#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/real_devices.h"
#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

namespace {

bool ends(const hal::DisplayEvent& event) {
  if (event.kind == hal::DisplayEventKind::close_requested)
    return true;
  return event.kind == hal::DisplayEventKind::key_pressed &&
         (event.key == static_cast<std::uint16_t>(hal::Key::enter) ||
          event.key == static_cast<std::uint16_t>(hal::Key::escape));
}

} // namespace

void SpectrumDisplay::open(const RunOptions& options, const Configuration& configuration) {
  RunOptions display_alone = options;
  display_alone.simulate = true;                    // no other device is looked for
  display_alone.display = DisplayChoice::automatic; // captures have none
  DeviceConfig config = configuration.devices;
  config.seat = false; // a seat's manager would keep the keyboard of this terminal's console
  auto real = std::make_unique<RealDevices>(config, plan_of(options, configuration), clock_);
  const DeviceChoices choices =
      choose_devices(real->find_for(display_alone), display_alone, config);
  if (choices.display.backend == "offscreen")
    return go_on_without(choices.display.reason);
  devices_.emplace(std::move(real), choices, clock_);
  hal::DisplayConfig wanted = display_config(options, configuration);
  wanted.fullscreen = true;
  if (const auto opened = devices_->display().open(wanted); !opened)
    go_on_without(opened.error().message);
}

void SpectrumDisplay::show(const LiveLook& found) {
  if (!devices_)
    return;
  if (const auto drawn = draw(found); !drawn)
    go_on_without(drawn.error().message);
}

hal::Result<> SpectrumDisplay::draw(const LiveLook& found) {
  hal::Display& display = devices_->display();
  if (!screen_ || screen_->width() != display.width() || screen_->height() != display.height()) {
    screen_.reset();
    HAL_TRY(auto made, ui::SpectrumScreen::create(display.width(), display.height()));
    screen_.emplace(std::move(made));
  }
  const auto figures = figures_of(found);
  screen_->draw({.mean = found.mean_line,
                 .last = found.one_line,
                 .highest = found.highest_line,
                 .full_scale = static_cast<double>(found.format.full_scale()),
                 .dark = found.quality.dark_counts,
                 .figures = figures});
  HAL_CHECK(display.present());
  return {};
}

bool SpectrumDisplay::ended() {
  if (!devices_)
    return false;
  std::array<hal::DisplayEvent, 16> events;
  for (std::size_t count = events.size(); count == events.size();) {
    count = devices_->display().poll_events(events);
    if (std::any_of(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(count), ends))
      return true;
  }
  return false;
}

void SpectrumDisplay::close() {
  screen_.reset(); // before its context
  if (devices_)
    devices_->display().close();
  devices_.reset();
}

void SpectrumDisplay::go_on_without(std::string_view why) {
  close();
  show_progress(""); // what stands there
  if (!std::exchange(told_, true))
    say("No display: {}. The spectrum is on the terminal alone; on the display, too, where this "
        "is put right and the step repeated.\n",
        why.substr(0, why.find(';'))); // after that, what options of `run` help
}

} // namespace octascope::firmware_host
