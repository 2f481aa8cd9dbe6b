#include "firmware-host/device_choice.h"

#include <fmt/format.h>

namespace octascope::firmware_host {

namespace {

// This version drives no real device of these kinds yet; the twin serves, and the reason says what
// is plugged in.
DeviceChoice twin(std::string_view device, const std::vector<FoundDevice>& found,
                  std::string_view what, bool asked_for) {
  if (asked_for)
    return {device, "sim", "the simulated twin was asked for"};
  if (found.empty())
    return {device, "sim", fmt::format("no {} is plugged in", what)};
  return {device, "sim",
          fmt::format("{} {} found ({} {}), but this version has no backend for it yet",
                      found.size(), what, found.front().node, found.front().name)};
}

DeviceChoice display(const HardwareSurvey& survey, DisplayChoice wish) {
  constexpr std::string_view device = "display";
  switch (wish) {
  case DisplayChoice::window: return {device, "window", "a window was asked for"};
  case DisplayChoice::offscreen: return {device, "offscreen", "offscreen was asked for"};
  case DisplayChoice::kms: return {device, "kms", "a console display was asked for"};
  case DisplayChoice::automatic: break;
  }
  if (survey.has_window_system)
    return {device, "window", "a window system is running (DISPLAY or WAYLAND_DISPLAY is set)"};
  if (!survey.displays.empty())
    return {device, "offscreen",
            fmt::format("{} display connectors found, but this version cannot drive a console "
                        "display (KMS) yet",
                        survey.displays.size())};
  return {device, "offscreen", "no window system and no display connector"};
}

} // namespace

DeviceChoices choose_devices(const HardwareSurvey& survey, const RunOptions& options) {
  DeviceChoices choices{
      twin("line_camera", survey.video, "video device", options.simulate),
      twin("galvo_trigger", survey.gpio, "GPIO chip", options.simulate),
      twin("control_input", survey.hid, "HID device", options.simulate),
      twin("scope_camera", survey.video, "video device", options.simulate),
      display(survey, options.display),
  };
  if (options.recording)
    choices.line_camera = {"line_camera", "recording", "spectra from a file were asked for"};
  return choices;
}

} // namespace octascope::firmware_host
