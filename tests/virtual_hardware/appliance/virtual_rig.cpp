#include "tests/virtual_hardware/appliance/virtual_rig.h"

#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/linux/realtime.h"
#include "pipeline/calibration/calibration_writer.h"
#include "sim/spectra/recorded_spectra.h"
#include "sim/spectra/volume_loop.h"
#include "sim/spectrometer/spectrometer.h"

namespace octascope::tests {

using namespace std::chrono_literals;

namespace {

constexpr unsigned trigger_line = 0, sync_line = 1;

// An eighth of a sweep, and long enough for the processor that the appliance shares with its rig: each look is
// two system calls, which user-mode Linux makes dear.
constexpr hal::Duration look_every = 4ms;
constexpr int pulse_width_us = 60000; // is not overlooked

// vkms maps all pages of a picture for each flip; user-mode Linux takes 17 µs for each of them and 23 µs to let
// go of it, and lets nobody else run meanwhile: in vkms' own mode 13 and 18 ms, and sweeps come late.
constexpr const char* monitor_mode = "640x480@60";

constexpr int scanner_priority = 60; // above the appliance: hardware does not wait for it

} // namespace

std::string virtual_rig_missing() {
  if (auto missing = sim_gpio_missing(); !missing.empty())
    return missing;
  if (auto missing = virtual_pedal_missing(); !missing.empty())
    return missing;
  if (!LoopbackFeeder::find())
    return "no v4l2loopback node";
  if (!std::filesystem::exists("/sys/class/drm/card0-Virtual-1"))
    return "no virtual display (vkms)";
  return {};
}

pipeline::ScanPlan VirtualRig::plan() {
  pipeline::ScanPlan plan;
  plan.samples = 1024;
  plan.a_scans = 96;
  plan.fly_back_lines = 32;
  plan.b_scans = 24;
  plan.line_rate_hz = 3.75e3;
  plan.a_spacing_um = 40;
  plan.b_spacing_um = 105;
  return plan;
}

hal::Result<> write_virtual_rig_configuration(const std::filesystem::path& folder,
                                              VirtualRigStart start) {
  const pipeline::ScanPlan p = VirtualRig::plan();
  sim::SpectrometerConfig config;
  config.samples = p.samples;
  HAL_TRY(const auto spectrometer, sim::Spectrometer::make(config));
  pipeline::FoundCalibration found;
  found.calibration = pipeline::Calibration::identity(p.samples);
  found.calibration.positions = spectrometer.true_k_positions();
  found.calibration.dispersion_rad = spectrometer.true_dispersion_rad();
  found.spacing_known = true; // the phantom's own
  found.provenance = {"bench", "the phantom's own", "none", "now", "exact"};
  const bool at_boot = start == VirtualRigStart::at_boot;
  std::filesystem::create_directories(folder);
  HAL_CHECK(pipeline::write_calibration(found, folder / "calibration.toml"));
  std::ofstream{folder / "octascope.toml"} << fmt::format(
      R"([scan]
samples = {}
a_scans = {}
fly_back_lines = {}
b_scans = {}
line_rate_hz = {}
a_spacing_um = {}
b_spacing_um = {}
[calibration]
file = "calibration.toml"
[devices]
significant_bits = {}
pulse_width_us = {}
sync_line = "octascope-sync"
line_camera = "{}"
scope_camera = "{}"
seat = {}
mode = "{}"
[controls]
keyboards = ["046d:c31c"]
)",
      p.samples, p.a_scans, p.fly_back_lines, p.b_scans, p.line_rate_hz, p.a_spacing_um,
      p.b_spacing_um, config.significant_bits, pulse_width_us, at_boot ? "v4l2" : "auto",
      at_boot ? "libcamera" : "auto", at_boot, monitor_mode);
  return {};
}

hal::Result<std::unique_ptr<sim::SpectraSource>> virtual_rig_phantom(int volumes,
                                                                     const std::string& phantom) {
  sim::VolumeLoopConfig loop;
  loop.phantom = phantom;
  loop.plan = VirtualRig::plan();
  loop.volumes = volumes;
  HAL_TRY(auto spectra, sim::VolumeLoop::make(loop));
  return spectra;
}

hal::Result<> write_virtual_rig_spectra(const std::filesystem::path& file) {
  HAL_TRY(const auto spectra, virtual_rig_phantom(1));
  std::ofstream out{file, std::ios::binary};
  for (int sweep = 0; sweep < spectra->sweeps(); ++sweep) {
    const std::span<const std::byte> frame = spectra->frame(0, sweep);
    out.write(reinterpret_cast<const char*>(frame.data()), std::ssize(frame));
  }
  if (!out.flush())
    return hal::fail(hal::ErrorCode::system, file.string() + " cannot be written");
  return {};
}

hal::Result<std::unique_ptr<sim::SpectraSource>>
read_virtual_rig_spectra(const std::filesystem::path& file) {
  const pipeline::ScanPlan plan = VirtualRig::plan();
  const auto count = static_cast<std::size_t>(plan.sweeps()) *
                     static_cast<std::size_t>(plan.lines_per_frame()) *
                     static_cast<std::size_t>(plan.samples);
  const auto samples = std::make_shared<std::vector<std::uint16_t>>(count);
  std::ifstream in{file, std::ios::binary};
  if (!in.read(reinterpret_cast<char*>(samples->data()), std::ssize(*samples) * 2))
    return hal::fail(hal::ErrorCode::system,
                     fmt::format("{} cannot be read, or has less than {} samples; write it with "
                                 "'virtual_rig spectra'",
                                 file.string(), count));
  sim::SpectraRecording recording{.samples = std::as_bytes(std::span{*samples}),
                                  .b_scans = plan.sweeps(),
                                  .a_scans = plan.lines_per_frame(),
                                  .samples_per_line = plan.samples,
                                  .significant_bits = 12,
                                  .name = file.filename().string(),
                                  .keep_alive = samples};
  HAL_TRY(auto spectra, sim::RecordedSpectra::make(std::move(recording)));
  return spectra;
}

hal::Result<std::unique_ptr<VirtualRig>>
VirtualRig::make(std::unique_ptr<sim::SpectraSource> spectra) {
  std::unique_ptr<VirtualRig> virtual_rig{new VirtualRig};
  virtual_rig->spectra_ = std::move(spectra);
  HAL_TRY(auto chip, SimGpioChip::make("scanner", {"octascope-trigger", "octascope-sync"}));
  virtual_rig->chip_ = std::move(chip);
  HAL_TRY(auto feeder, LoopbackFeeder::open(LoopbackFeeder::find().value(), plan().samples,
                                            plan().lines_per_frame()));
  virtual_rig->feeder_ = std::make_unique<LoopbackFeeder>(std::move(feeder));
  // The node is a camera from the first frame on.
  HAL_CHECK(virtual_rig->feeder_->write(virtual_rig->spectra_->frame(0, 0)));
  HAL_CHECK(virtual_rig->plug_pedal());
  VirtualRig& scene = *virtual_rig;
  scene.scanner_ = std::jthread{[&scene](std::stop_token stop) { scene.scan(stop); }};
  return virtual_rig;
}

VirtualRig::~VirtualRig() = default;

hal::Result<> VirtualRig::plug_pedal() {
  HAL_TRY(auto pedal, VirtualPedal::plug_in(vec_pedal()));
  pedal_ = std::move(pedal);
  return {};
}

hal::Result<std::unique_ptr<VirtualKeyboard>> VirtualRig::plug_keyboard() {
  return VirtualKeyboard::plug_in(0x046d, 0xc31c);
}

hal::Result<std::unique_ptr<VirtualKeyboard>> VirtualRig::plug_strange_keyboard() {
  return VirtualKeyboard::plug_in(0x1234, 0x5678);
}

void VirtualRig::scan(std::stop_token stop) {
  static_cast<void>(hal::linux_backend::make_this_thread_realtime(scanner_priority));
  while (wait_for_pulse(stop)) {
    const hal::TimePoint pulse = clock_.now();
    ++pulses_;
    if (!mute_)
      answer();
    sweep(pulse);
  }
}

// The rising edge; a line that was high already when the sweeps ended is a latched pulse.
bool VirtualRig::wait_for_pulse(std::stop_token stop) {
  while (!stop.stop_requested()) {
    if (chip_->level(trigger_line))
      return true;
    clock_.sleep_for(look_every);
  }
  return false;
}

// One edge up; in vain while the plug is pulled.
void VirtualRig::answer() {
  static_cast<void>(chip_->pull(sync_line, true));
  static_cast<void>(chip_->pull(sync_line, false));
}

void VirtualRig::look_at(std::unique_ptr<sim::SpectraSource> spectra) {
  const std::lock_guard lock{spectra_mutex_};
  spectra_ = std::move(spectra);
}

void VirtualRig::sweep(hal::TimePoint pulse) {
  const std::lock_guard lock{spectra_mutex_};
  const pipeline::ScanPlan p = plan();
  for (int sweep = 0; sweep < p.sweeps(); ++sweep) {
    clock_.sleep_until(pulse + (sweep + 1) * p.frame_period());
    if (blind_)
      continue;
    if (feeder_->write(spectra_->frame(volume_, sweep)))
      ++frames_;
  }
  ++volume_;
}

} // namespace octascope::tests
