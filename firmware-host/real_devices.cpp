#include "firmware-host/real_devices.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware-host/configuration.h"
#include "firmware-host/control_device_file.h"
#include "firmware-host/hardware_survey.h"
#include "hal/linux/gpio/gpio_galvo_trigger.h"
#include "hal/linux/gpio/gpio_lookup.h"
#include "hal/linux/hid/hid_controls.h"
#include "hal/linux/hid/hid_survey.h"
#include "hal/linux/kms/card_survey.h"
#include "hal/linux/kms/kms_display.h"
#include "hal/linux/kms/output_choice.h"
#include "hal/linux/libcamera/libcamera_scope_camera.h"
#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "hal/linux/v4l2/video_nodes.h"
#include "ui/controls/built_in_profiles.h"

namespace octascope::firmware_host {

namespace backend = hal::linux_backend;

namespace {

// Of a camera that offers several depths, the deepest.
constexpr std::array depths_bits{16, 14, 12, 10, 8};

hal::LineFormat wanted_format(const DeviceWishes& wishes, const pipeline::ScanPlan& plan,
                              int significant_bits) {
  return {.samples_per_line = plan.samples,
          .lines_per_frame = plan.lines_per_frame(),
          .sample_type = significant_bits <= 8 ? hal::SampleType::u8 : hal::SampleType::u16,
          .significant_bits = significant_bits,
          .right_shift = wishes.right_shift};
}

// A wish that names one device, as "/dev/video0", and not a kind.
std::string named(const std::string& wish, std::string_view kind) {
  const bool general =
      wish == DeviceWishes::automatic || wish == DeviceWishes::twin || wish == kind;
  return general ? std::string{} : wish;
}

std::string node_wish(const DeviceWishes& wishes) {
  return named(wishes.line_camera, "v4l2");
}

backend::KmsConfig kms_config(const DeviceWishes& wishes) {
  const double margin = wishes.overscan_percent / 2;
  return {.connector = wishes.connector,
          .mode = wishes.mode,
          .overscan = {margin, margin, margin, margin},
          .seat = wishes.seat ? backend::KmsConfig::SeatUse::automatic
                              : backend::KmsConfig::SeatUse::plain};
}

} // namespace

RealDevices::RealDevices(DeviceWishes wishes, const pipeline::ScanPlan& plan, hal::Clock& clock)
    : wishes_{std::move(wishes)}, clock_{clock}, format_{wanted_format(
                                                     wishes_, plan,
                                                     wishes_.significant_bits.value_or(12))} {}

DeviceFindings RealDevices::find() {
  DeviceFindings findings;
  findings.line_camera = find_line_camera(); // before the scope camera: it is none of those
  findings.galvo_trigger = find_galvo_trigger();
  findings.control_input = find_control_input();
  findings.scope_camera = find_scope_camera();
  findings.console_display = find_console_display();
  findings.has_window_system = has_window_system();
  return findings;
}

DeviceFindings RealDevices::find_for(const RunOptions& options) {
  DeviceFindings findings;
  findings.has_window_system = has_window_system();
  if (options.display == DisplayChoice::automatic && !findings.has_window_system)
    findings.console_display = find_console_display();
  if (options.simulate)
    return findings;
  findings.control_input = find_control_input();
  if (options.recording || options.replay || wishes_.line_camera == DeviceWishes::twin)
    return findings;
  findings.line_camera = find_line_camera();
  if (!findings.line_camera.usable && wishes_.line_camera == DeviceWishes::automatic)
    return findings;
  findings.galvo_trigger = find_galvo_trigger();
  if (wishes_.scope_camera == DeviceWishes::automatic)
    findings.scope_camera = find_scope_camera();
  return findings;
}

DeviceFinding RealDevices::find_line_camera() {
  std::string reason;
  std::vector<int> depths{depths_bits.begin(), depths_bits.end()};
  if (wishes_.significant_bits)
    depths = {*wishes_.significant_bits};
  for (const int bits : depths) {
    hal::LineFormat wanted = format_;
    wanted.significant_bits = bits;
    wanted.sample_type = bits <= 8 ? hal::SampleType::u8 : hal::SampleType::u16;
    std::vector<backend::LineCameraCandidate> candidates = backend::line_camera_candidates(wanted);
    if (const std::string node = node_wish(wishes_); !node.empty())
      std::erase_if(candidates, [&](const auto& found) { return found.identity.node != node; });
    const auto picked = backend::pick_line_camera(candidates, "", wanted);
    if (!picked) {
      if (bits == format_.significant_bits)
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

DeviceFinding RealDevices::find_galvo_trigger() const {
  const backend::GpioSurvey survey = backend::survey_gpio();
  const auto line = backend::find_gpio_line(survey, wishes_.trigger_line);
  if (!line)
    return {false, line.error().message};
  const std::string complaint = backend::gpio_complaint(survey, wishes_.trigger_line);
  if (!complaint.empty())
    return {false, complaint};
  return {true, fmt::format("{} line {}, {}", line->node, line->offset, wishes_.trigger_line)};
}

DeviceFinding RealDevices::find_control_input() const {
  const auto known =
      backend::known_controls(backend::survey_hid(), control_models(wishes_.control_device));
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
  auto started = backend::LibcameraSession::start();
  if (!started)
    return tl::make_unexpected(started.error());
  libcamera_ = std::move(*started);
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
  const auto chosen = backend::choose_camera(cameras, named(wishes_.scope_camera, "libcamera"));
  if (!chosen)
    return {false, chosen.error().message};
  return {true, fmt::format("{} ({})", cameras[*chosen].model, cameras[*chosen].id)};
}

DeviceFinding RealDevices::find_console_display() const {
  const std::vector<backend::kms::Card> cards = backend::kms::survey();
  backend::kms::OutputWish wish;
  wish.connector = wishes_.connector;
  if (!wishes_.mode.empty()) {
    const auto mode = backend::kms::parse_mode_wish(wishes_.mode);
    if (!mode)
      return {false, mode.error().message};
    wish.mode = *mode;
  }
  const auto output = backend::kms::choose_output(cards, wish);
  if (!output)
    return {false, output.error().message};
  const backend::kms::Card& card = cards[output->card];
  const backend::kms::Connector& connector = card.connectors[output->connector];
  return {true,
          fmt::format("{} {}{}, {}{}", backend::kms::card_name(card), connector.name,
                      connector.monitor.empty() ? "" : fmt::format(" ({})", connector.monitor),
                      backend::kms::to_text(output->mode),
                      wishes_.keyboards.empty()
                          ? ""
                          : fmt::format(", keyboards {}", fmt::join(wishes_.keyboards, ", ")))};
}

std::unique_ptr<hal::LineCamera> RealDevices::make_line_camera() {
  backend::V4l2CameraOptions options;
  options.node = node_wish(wishes_);
  options.input = wishes_.camera_input;
  options.settings.exposure_us = wishes_.exposure_us;
  options.settings.gain = wishes_.gain;
  return std::make_unique<backend::V4l2LineCamera>(std::move(options), clock_);
}

std::unique_ptr<hal::GalvoTrigger> RealDevices::make_galvo_trigger() {
  backend::GpioTriggerSettings settings;
  settings.line = wishes_.trigger_line;
  settings.sync_line = wishes_.sync_line;
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
      std::make_unique<backend::HidControls>(clock_, control_models(wishes_.control_device));
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
  if (auto started = start_libcamera(); !started)
    return tl::make_unexpected(started.error());
  return std::make_unique<backend::LibcameraScopeCamera>(
      *libcamera_,
      backend::LibcameraScopeOptions{.camera = named(wishes_.scope_camera, "libcamera"),
                                     .taken_nodes = taken_nodes()},
      clock_);
}

std::unique_ptr<hal::Display> RealDevices::make_display() {
  std::unique_ptr<backend::ConsoleKeyboards> keyboards;
  if (!wishes_.keyboards.empty())
    keyboards = std::make_unique<backend::ConsoleKeyboards>(clock_, wishes_.keyboards);
  keyboards_ = keyboards.get();
  return std::make_unique<backend::KmsDisplay>(clock_, kms_config(wishes_), std::move(keyboards));
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
