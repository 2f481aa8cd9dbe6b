#include "firmware-host/devices/device_choice.h"

#include <fmt/format.h>

namespace octascope::firmware_host {

using pipeline::Device;

namespace {

constexpr std::string_view twin_asked_for = "the simulated twin was asked for";
constexpr std::string_view volumes_from_a_file = "volumes from a file were asked for";

std::string asked_for(std::string_view wanted) {
  return fmt::format("the configuration asks for it ({})", wanted);
}

DeviceChoice line_camera(const DeviceFinding& found, const RunOptions& options,
                         std::string_view wanted) {
  constexpr Device device = Device::line_camera;
  if (options.replay)
    return {device, "none", std::string{volumes_from_a_file}};
  if (options.recording)
    return {device, "recording", "spectra from a file were asked for"};
  if (options.simulate || wanted == DeviceConfig::twin)
    return {device, "sim", std::string{twin_asked_for}};
  if (genicam_address(wanted))
    return {device, "aravis", fmt::format("{}: {}", asked_for(wanted), found.what)};
  if (wanted != DeviceConfig::automatic)
    return {device, "v4l2", asked_for(wanted)};
  return {device, found.usable ? "v4l2" : "sim", found.what};
}

DeviceChoice galvo_trigger(const DeviceFinding& found, bool real_camera, const RunOptions& options,
                           std::string_view wanted) {
  constexpr Device device = Device::galvo_trigger;
  if (options.replay)
    return {device, "none", std::string{volumes_from_a_file}};
  if (!real_camera)
    return {device, "sim", "it triggers the simulated line camera"};
  if (wanted == DeviceConfig::twin)
    return {device, "sim", fmt::format("{}: nothing triggers the scanner", twin_asked_for)};
  return {device, "gpio", found.what};
}

DeviceChoice control_input(const DeviceFinding& found, bool real_camera, const RunOptions& options,
                           std::string_view wanted) {
  constexpr Device device = Device::control_input;
  if (options.simulate || options.controls || wanted == DeviceConfig::twin)
    return {device, "sim", std::string{twin_asked_for}};
  if (wanted != DeviceConfig::automatic)
    return {device, "hid", found.usable ? found.what : asked_for(wanted)};
  return {device, found.usable || real_camera ? "hid" : "sim", found.what};
}

DeviceChoice scope_camera(const DeviceFinding& found, bool real_camera, const RunOptions& options,
                          std::string_view wanted) {
  constexpr Device device = Device::scope_camera;
  if (wanted == DeviceConfig::nothing)
    return {device, "none", asked_for(wanted)};
  if (options.replay)
    return {device, "none", std::string{volumes_from_a_file}};
  if (options.recording)
    return {device, "none", "a recording of spectra has no microscope picture"};
  if (!real_camera)
    return {device, "sim",
            options.simulate || wanted == DeviceConfig::twin
                ? std::string{twin_asked_for}
                : "beside simulated spectra the microscope's picture is simulated, too"};
  if (wanted == DeviceConfig::twin)
    return {device, "none", "a simulated picture is not shown beside a patient's spectra"};
  if (wanted != DeviceConfig::automatic)
    return {device, "libcamera", asked_for(wanted)};
  return {device, found.usable ? "libcamera" : "none", found.what};
}

DeviceChoice display(const DetectedDevices& detected, DisplayChoice wanted) {
  constexpr Device device = Device::display;
  switch (wanted) {
  case DisplayChoice::window: return {device, "window", "a window was asked for"};
  case DisplayChoice::offscreen: return {device, "offscreen", "offscreen was asked for"};
  case DisplayChoice::kms: return {device, "kms", "a console display was asked for"};
  case DisplayChoice::automatic: break;
  }
  if (detected.has_window_system)
    return {device, "window", "a window system is running (DISPLAY or WAYLAND_DISPLAY is set)"};
  if (detected.console_display.usable)
    return {device, "kms", detected.console_display.what};
  return {device, "offscreen", "no window system, and " + detected.console_display.what};
}

// A camera on the machine's own loopback: its twin's trigger serves, as no scanner is pulsed for it.
bool simulates_genicam(std::string_view wanted) {
  const auto address = genicam_address(wanted);
  return address && address->simulated();
}

} // namespace

std::optional<hal::linux_backend::GenicamAddress> genicam_address(std::string_view wanted) {
  return hal::linux_backend::parse_genicam_address(wanted).value_or(std::nullopt);
}

bool is_camera_backend(std::string_view backend) {
  return backend == "v4l2" || backend == "aravis";
}

DeviceChoices choose_devices(const DetectedDevices& detected, const RunOptions& options,
                             const DeviceConfig& config) {
  DeviceChoices choices;
  choices.line_camera = line_camera(detected.line_camera, options, config.line_camera);
  const bool real_camera =
      is_camera_backend(choices.line_camera.backend) && !simulates_genicam(config.line_camera);
  choices.galvo_trigger =
      galvo_trigger(detected.galvo_trigger, real_camera, options, config.galvo_trigger);
  choices.control_input =
      control_input(detected.control_input, real_camera, options, config.control_input);
  choices.scope_camera =
      scope_camera(detected.scope_camera, real_camera, options, config.scope_camera);
  if (choices.line_camera.backend == "aravis" && !real_camera)
    choices.scope_camera = {Device::scope_camera, "none",
                            "beside a camera on the loopback there is no microscope picture"};
  choices.display = display(detected, options.display);
  return choices;
}

bool camera_may_come(const DeviceChoices& choices, const RunOptions& options,
                     const DeviceConfig& config) {
  return choices.line_camera.backend == "sim" && !options.simulate &&
         config.line_camera == DeviceConfig::automatic;
}

} // namespace octascope::firmware_host
