#include "firmware-host/device_choice.h"

#include <fmt/format.h>

namespace octascope::firmware_host {

namespace {

constexpr std::string_view twin_asked_for = "the simulated twin was asked for";
constexpr std::string_view volumes_from_a_file = "volumes from a file were asked for";

std::string asked_for(std::string_view wish) {
  return fmt::format("the configuration asks for it ({})", wish);
}

DeviceChoice line_camera(const DeviceFinding& found, const RunOptions& options,
                         std::string_view wish) {
  constexpr std::string_view device = "line_camera";
  if (options.replay)
    return {device, "none", std::string{volumes_from_a_file}};
  if (options.recording)
    return {device, "recording", "spectra from a file were asked for"};
  if (options.simulate || wish == DeviceWishes::twin)
    return {device, "sim", std::string{twin_asked_for}};
  if (wish != DeviceWishes::automatic)
    return {device, "v4l2", asked_for(wish)};
  return {device, found.usable ? "v4l2" : "sim", found.what};
}

DeviceChoice galvo_trigger(const DeviceFinding& found, bool real_camera, const RunOptions& options,
                           std::string_view wish) {
  constexpr std::string_view device = "galvo_trigger";
  if (options.replay)
    return {device, "none", std::string{volumes_from_a_file}};
  if (!real_camera)
    return {device, "sim", "it triggers the simulated line camera"};
  if (wish == DeviceWishes::twin)
    return {device, "sim", fmt::format("{}: nothing triggers the scanner", twin_asked_for)};
  return {device, "gpio", found.what};
}

DeviceChoice control_input(const DeviceFinding& found, bool real_camera, const RunOptions& options,
                           std::string_view wish) {
  constexpr std::string_view device = "control_input";
  if (options.simulate || options.controls || wish == DeviceWishes::twin)
    return {device, "sim", std::string{twin_asked_for}};
  if (wish != DeviceWishes::automatic)
    return {device, "hid", found.usable ? found.what : asked_for(wish)};
  return {device, found.usable || real_camera ? "hid" : "sim", found.what};
}

DeviceChoice scope_camera(const DeviceFinding& found, bool real_camera, const RunOptions& options,
                          std::string_view wish) {
  constexpr std::string_view device = "scope_camera";
  if (wish == DeviceWishes::nothing)
    return {device, "none", asked_for(wish)};
  if (options.replay)
    return {device, "none", std::string{volumes_from_a_file}};
  if (options.recording)
    return {device, "none", "a recording of spectra has no microscope picture"};
  if (!real_camera)
    return {device, "sim",
            options.simulate || wish == DeviceWishes::twin
                ? std::string{twin_asked_for}
                : "beside simulated spectra the microscope's picture is simulated, too"};
  if (wish == DeviceWishes::twin)
    return {device, "none", "a simulated picture is not shown beside a patient's spectra"};
  if (wish != DeviceWishes::automatic)
    return {device, "libcamera", asked_for(wish)};
  return {device, found.usable ? "libcamera" : "none", found.what};
}

DeviceChoice display(const DeviceFindings& findings, DisplayChoice wish) {
  constexpr std::string_view device = "display";
  switch (wish) {
  case DisplayChoice::window: return {device, "window", "a window was asked for"};
  case DisplayChoice::offscreen: return {device, "offscreen", "offscreen was asked for"};
  case DisplayChoice::kms: return {device, "kms", "a console display was asked for"};
  case DisplayChoice::automatic: break;
  }
  if (findings.has_window_system)
    return {device, "window", "a window system is running (DISPLAY or WAYLAND_DISPLAY is set)"};
  if (findings.console_display.usable)
    return {device, "kms", findings.console_display.what};
  return {device, "offscreen", "no window system, and " + findings.console_display.what};
}

} // namespace

DeviceChoices choose_devices(const DeviceFindings& findings, const RunOptions& options,
                             const DeviceWishes& wishes) {
  DeviceChoices choices;
  choices.line_camera = line_camera(findings.line_camera, options, wishes.line_camera);
  const bool real_camera = choices.line_camera.backend == "v4l2";
  choices.galvo_trigger =
      galvo_trigger(findings.galvo_trigger, real_camera, options, wishes.galvo_trigger);
  choices.control_input =
      control_input(findings.control_input, real_camera, options, wishes.control_input);
  choices.scope_camera =
      scope_camera(findings.scope_camera, real_camera, options, wishes.scope_camera);
  choices.display = display(findings, options.display);
  return choices;
}

bool camera_may_come(const DeviceChoices& choices, const RunOptions& options,
                     const DeviceWishes& wishes) {
  return choices.line_camera.backend == "sim" && !options.simulate &&
         wishes.line_camera == DeviceWishes::automatic;
}

} // namespace octascope::firmware_host
