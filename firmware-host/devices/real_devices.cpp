#include "firmware-host/devices/real_devices.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/control_device_file.h"
#include "firmware-host/devices/hardware_survey.h"
#include "hal/linux/aravis/genicam_camera.h"
#include "hal/linux/aravis/genicam_pixels.h"
#include "hal/linux/gpio/gpio_lookup.h"
#include "hal/linux/hid/survey/hid_survey.h"
#include "hal/linux/kms/drm/card_survey.h"
#include "hal/linux/kms/kms_display.h"
#include "hal/linux/kms/mode/output_choice.h"
#include "hal/linux/libcamera/libcamera_scope_camera.h"
#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "hal/linux/v4l2/video_nodes.h"
#include "ui/controls/built_in_profiles.h"

namespace octascope::firmware_host {

namespace backend = hal::linux_backend;

namespace {

hal::LineFormat wanted_format(const DeviceConfig& config, const pipeline::ScanPlan& plan) {
  return backend::with_depth({.samples_per_line = plan.samples,
                              .lines_per_frame = plan.lines_per_frame(),
                              .right_shift = config.right_shift},
                             config.significant_bits.value_or(12));
}

// Which formats of one that comes after all was set up serve.
backend::Depths depths_of(const DeviceConfig& config, bool counts_matter) {
  if (config.significant_bits)
    return backend::Depths::wanted;
  return counts_matter ? backend::Depths::own : backend::Depths::any;
}

// A wanted that names one device, as "/dev/video0", and not a kind.
std::string named(const std::string& wanted, std::string_view kind) {
  const bool general =
      wanted == DeviceConfig::automatic || wanted == DeviceConfig::twin || wanted == kind;
  return general ? std::string{} : wanted;
}

std::string configured_node(const DeviceConfig& config) {
  return named(config.line_camera, "v4l2");
}

backend::KmsConfig kms_config(const DeviceConfig& config) {
  const double margin = config.overscan_percent / 2;
  return {.connector = config.connector,
          .mode = config.mode,
          .overscan = {margin, margin, margin, margin},
          .seat = config.seat ? backend::KmsConfig::SeatUse::automatic
                              : backend::KmsConfig::SeatUse::plain};
}

} // namespace

RealDevices::RealDevices(DeviceConfig config, const pipeline::ScanPlan& plan, hal::Clock& clock)
    : config_{std::move(config)}, clock_{clock}, format_{wanted_format(config_, plan)} {}

DetectedDevices RealDevices::find() {
  DetectedDevices detected;
  detected.line_camera = find_line_camera(); // before the scope camera: it is none of those
  detected.galvo_trigger = find_galvo_trigger();
  detected.control_input = find_control_input();
  detected.scope_camera = find_scope_camera();
  detected.console_display = find_console_display();
  detected.has_window_system = has_window_system();
  return detected;
}

DetectedDevices RealDevices::find_for(const RunOptions& options) {
  DetectedDevices detected;
  detected.has_window_system = has_window_system();
  if (options.display == DisplayChoice::automatic && !detected.has_window_system)
    detected.console_display = find_console_display();
  if (options.simulate)
    return detected;
  detected.control_input = find_control_input();
  if (options.recording || options.replay || config_.line_camera == DeviceConfig::twin)
    return detected;
  detected.line_camera = find_line_camera();
  if (!detected.line_camera.usable && config_.line_camera == DeviceConfig::automatic)
    return detected;
  detected.galvo_trigger = find_galvo_trigger();
  if (config_.scope_camera == DeviceConfig::automatic)
    detected.scope_camera = find_scope_camera();
  return detected;
}

std::vector<hal::LineFormat> RealDevices::formats_to_try() const {
  if (config_.significant_bits)
    return {format_};
  std::vector<hal::LineFormat> formats;
  for (const int bits : backend::depths_bits)
    formats.push_back(backend::with_depth(format_, bits));
  return formats;
}

DeviceFinding RealDevices::find_line_camera() {
  if (const auto genicam = genicam_address(config_.line_camera))
    return find_genicam(*genicam);
  std::string reason;
  for (const hal::LineFormat& wanted : formats_to_try()) {
    std::vector<backend::LineCameraCandidate> candidates = backend::line_camera_candidates(wanted);
    if (const std::string node = configured_node(config_); !node.empty())
      std::erase_if(candidates, [&](const auto& found) { return found.identity.node != node; });
    const auto picked = backend::pick_line_camera(candidates, "", wanted);
    if (!picked) {
      if (wanted.significant_bits == format_.significant_bits)
        reason = picked.error().message;
      continue;
    }
    line_node_ = *picked;
    format_ = wanted;
    const auto found =
        std::ranges::find(candidates, *picked, [](const auto& c) { return c.identity.node; });
    return {true, fmt::format("{} is the camera \"{}\" ({}) and offers {}", *picked,
                              found->identity.camera, found->identity.driver, found->formats)};
  }
  return {false, reason};
}

DeviceFinding RealDevices::find_genicam(const backend::GenicamAddress& address) {
  const auto found = backend::find_genicam_camera(address);
  if (!found && found.error().code == hal::ErrorCode::absent && !config_.significant_bits &&
      config_.right_shift == 0)
    return {false, fmt::format("{}; if it comes later, its samples are brought to {} bits, unless "
                               "the calibration has a recorded background",
                               found.error().message, format_.significant_bits)};
  if (!found)
    return {false, found.error().message};
  const std::vector<hal::LineFormat> formats = formats_to_try();
  const auto fitting = std::ranges::find_if(formats, [&](const hal::LineFormat& wanted) {
    return backend::choose_genicam_format(found->pixel_formats, wanted).has_value();
  });
  if (fitting == formats.end())
    return {false,
            backend::choose_genicam_format(found->pixel_formats, formats.front()).error().message};
  format_ = *fitting;
  return {true, fmt::format("{} is the camera \"{}\" and offers {}", to_text(address),
                            found->camera, fmt::join(found->pixel_formats, ", "))};
}

DeviceFinding RealDevices::find_galvo_trigger() const {
  const backend::GpioSurvey survey = backend::survey_gpio();
  const auto line = backend::find_gpio_line(survey, config_.trigger_line);
  if (!line)
    return {false, line.error().message};
  const std::string complaint = backend::gpio_complaint(survey, config_.trigger_line);
  if (!complaint.empty())
    return {false, complaint};
  return {true, fmt::format("{} line {}, {}", line->node, line->offset, config_.trigger_line)};
}

DeviceFinding RealDevices::find_control_input() const {
  const auto known =
      backend::known_controls(backend::survey_hid(), control_models(config_.control_device));
  if (known.empty())
    return {false, "no pedal, knob or puck is plugged in that octascope knows; `octascope devices "
                   "--learn` learns another"};
  std::string names;
  for (const backend::PluggedControl& control : known)
    names += (names.empty() ? "" : ", ") + control.model.name + " at " + control.nodes.front().node;
  return {true, names};
}

hal::Result<> RealDevices::start_libcamera() {
  if (libcamera_)
    return {};
  HAL_TRY(auto started, backend::LibcameraSession::start());
  libcamera_ = std::move(started);
  return {};
}

std::vector<std::string> RealDevices::taken_nodes() const {
  if (line_node_.empty())
    return {};
  return {line_node_};
}

DeviceFinding RealDevices::find_scope_camera() {
  if (const auto started = start_libcamera(); !started)
    return {false, started.error().message};
  const auto cameras = libcamera_->cameras(taken_nodes());
  const auto chosen = backend::choose_camera(cameras, named(config_.scope_camera, "libcamera"));
  if (!chosen)
    return {false, chosen.error().message};
  return {true, fmt::format("{} ({})", cameras[*chosen].model, cameras[*chosen].id)};
}

DeviceFinding RealDevices::find_console_display() const {
  const std::vector<backend::kms::Card> cards = backend::kms::survey();
  backend::kms::OutputRequest wanted;
  wanted.connector = config_.connector;
  if (!config_.mode.empty()) {
    const auto mode = backend::kms::parse_mode_request(config_.mode);
    if (!mode)
      return {false, mode.error().message};
    wanted.mode = *mode;
  }
  const auto output = backend::kms::choose_output(cards, wanted);
  if (!output)
    return {false, output.error().message};
  const backend::kms::Card& card = cards[output->card];
  const backend::kms::Connector& connector = card.connectors[output->connector];
  return {true,
          fmt::format("{} {}{}, {}{}", backend::kms::card_name(card), connector.name,
                      connector.monitor.empty() ? "" : fmt::format(" ({})", connector.monitor),
                      backend::kms::to_text(output->mode),
                      config_.keyboards.empty()
                          ? ""
                          : fmt::format(", keyboards {}", fmt::join(config_.keyboards, ", ")))};
}

std::unique_ptr<hal::LineCamera> RealDevices::make_line_camera(bool counts_matter) {
  if (const auto address = genicam_address(config_.line_camera))
    return backend::make_genicam_camera({.address = *address,
                                         .exposure_us = config_.exposure_us,
                                         .gain = config_.gain,
                                         .trigger = config_.camera_trigger,
                                         .packet_resend = config_.packet_resend,
                                         .depths = depths_of(config_, counts_matter)},
                                        clock_);
  backend::V4l2CameraOptions options;
  options.node = configured_node(config_);
  options.input = config_.camera_input;
  options.settings.exposure_us = config_.exposure_us;
  options.settings.gain = config_.gain;
  return std::make_unique<backend::V4l2LineCamera>(std::move(options), clock_);
}

std::unique_ptr<hal::GalvoTrigger> RealDevices::make_galvo_trigger() {
  backend::GpioTriggerSettings settings;
  settings.line = config_.trigger_line;
  settings.sync_line = config_.sync_line;
  auto made = std::make_unique<backend::GpioGalvoTrigger>(clock_, std::move(settings));
  trigger_ = made.get();
  return made;
}

void RealDevices::make_trigger_safe() noexcept {
  if (trigger_ != nullptr)
    trigger_->make_safe();
}

std::uint64_t RealDevices::new_missed_answers() {
  const std::uint64_t missed = trigger_ != nullptr ? trigger_->counters().missed_edges : 0;
  return missed - std::exchange(missed_answers_, missed);
}

std::unique_ptr<hal::ControlInput> RealDevices::make_control_input() {
  auto made =
      std::make_unique<backend::HidControls>(clock_, control_models(config_.control_device));
  controls_ = made.get();
  return made;
}

std::optional<ui::ControlProfile> RealDevices::new_control_profile() {
  if (controls_ == nullptr || controls_->changes() == control_changes_)
    return std::nullopt;
  control_changes_ = controls_->changes();
  const std::vector<backend::ServingControl> serving = controls_->serving();
  if (!serving.empty()) {
    const backend::ControlModel& leading = serving.front().control.model;
    if (auto profile = ui::built_in_profile_for(backend::usb_id(leading.vendor, leading.product),
                                                leading.switches))
      return profile;
  }
  auto profile = ui::built_in_profile(ui::default_profile);
  return profile ? std::optional{std::move(*profile)} : std::nullopt;
}

hal::Result<std::unique_ptr<hal::ScopeCamera>> RealDevices::make_scope_camera() {
  HAL_CHECK(start_libcamera());
  return std::make_unique<backend::LibcameraScopeCamera>(
      *libcamera_,
      backend::LibcameraScopeOptions{.camera = named(config_.scope_camera, "libcamera"),
                                     .taken_nodes = taken_nodes()},
      clock_);
}

std::unique_ptr<hal::Display> RealDevices::make_display() {
  std::unique_ptr<backend::ConsoleKeyboards> keyboards;
  if (!config_.keyboards.empty())
    keyboards = std::make_unique<backend::ConsoleKeyboards>(clock_, config_.keyboards);
  keyboards_ = keyboards.get();
  return std::make_unique<backend::KmsDisplay>(clock_, kms_config(config_), std::move(keyboards));
}

std::optional<std::string> RealDevices::new_keyboard_complaint() {
  if (keyboards_ == nullptr || keyboards_->complaints().empty() ||
      keyboards_->complaints().front() == keyboard_complaint_)
    return std::nullopt;
  keyboard_complaint_ = keyboards_->complaints().front();
  return keyboard_complaint_;
}

hal::Result<DeviceChoices> choices_of_run(const RunOptions& options, hal::Clock& clock) {
  return configuration_of(options).map([&](const Configuration& configuration) {
    RealDevices real{configuration.devices, plan_of(options, configuration), clock};
    return choose_devices(real.find(), options, configuration.devices);
  });
}

} // namespace octascope::firmware_host
