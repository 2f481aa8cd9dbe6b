#include "tests/virtual_hardware/appliance/theatre.h"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "hal/linux/realtime.h"
#include "pipeline/calibration_writer.h"

namespace octascope::tests {

using namespace std::chrono_literals;

namespace {

constexpr const char* configuration_folder = "/etc/octascope";
constexpr unsigned trigger_line = 0, sync_line = 1;

// Long enough to be seen by one who looks every half a millisecond.
constexpr int pulse_width_us = 20000;

constexpr int scanner_priority = 60; // above the appliance: hardware does not wait for it

} // namespace

std::string theatre_missing() {
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

pipeline::ScanPlan Theatre::plan() {
  pipeline::ScanPlan plan;
  plan.samples = 1024;
  plan.a_scans = 96;
  plan.fly_back_lines = 32;
  plan.b_scans = 32;
  plan.line_rate_hz = 5e3;
  plan.a_spacing_um = 40;
  plan.b_spacing_um = 80;
  return plan;
}

hal::Result<std::unique_ptr<Theatre>> Theatre::make() {
  std::unique_ptr<Theatre> theatre{new Theatre};
  sim::VolumeLoopConfig loop;
  loop.plan = plan();
  loop.volumes = 2;
  auto spectra = sim::VolumeLoop::make(loop);
  if (!spectra)
    return tl::make_unexpected(spectra.error());
  theatre->spectra_ = std::move(*spectra);
  auto chip = SimGpioChip::make("scanner", {"octascope-trigger", "octascope-sync"});
  if (!chip)
    return tl::make_unexpected(chip.error());
  theatre->chip_ = std::move(*chip);
  auto feeder = LoopbackFeeder::open(LoopbackFeeder::find().value(), plan().samples,
                                     plan().lines_per_frame());
  if (!feeder)
    return tl::make_unexpected(feeder.error());
  theatre->feeder_ = std::make_unique<LoopbackFeeder>(std::move(*feeder));
  // The node is a camera from the first frame on.
  if (auto written = theatre->feeder_->write(theatre->spectra_->frame(0, 0)); !written)
    return tl::make_unexpected(written.error());
  if (auto plugged = theatre->plug_pedal(); !plugged)
    return tl::make_unexpected(plugged.error());
  if (auto written = theatre->write_configuration(); !written)
    return tl::make_unexpected(written.error());
  Theatre& scene = *theatre;
  scene.scanner_ = std::jthread{[&scene](std::stop_token stop) { scene.scan(stop); }};
  return theatre;
}

Theatre::~Theatre() = default;

hal::Result<> Theatre::plug_pedal() {
  auto pedal = VirtualPedal::plug_in(vec_pedal());
  if (!pedal)
    return tl::make_unexpected(pedal.error());
  pedal_ = std::move(*pedal);
  return {};
}

hal::Result<std::unique_ptr<VirtualKeyboard>> Theatre::plug_keyboard() {
  return VirtualKeyboard::plug_in(0x046d, 0xc31c);
}

hal::Result<std::unique_ptr<VirtualKeyboard>> Theatre::plug_strange_keyboard() {
  return VirtualKeyboard::plug_in(0x1234, 0x5678);
}

hal::Result<> Theatre::write_configuration() const {
  std::filesystem::create_directories(configuration_folder);
  const std::filesystem::path folder{configuration_folder};
  pipeline::FoundCalibration found;
  found.calibration = pipeline::Calibration::identity(plan().samples);
  found.calibration.positions = spectra_->spectrometer().true_k_positions();
  found.calibration.dispersion_rad = spectra_->spectrometer().true_dispersion_rad();
  found.provenance = {"bench", "the phantom's own", "none", "now", "exact"};
  if (auto written = pipeline::write_calibration(found, folder / "calibration.toml"); !written)
    return written;
  const pipeline::ScanPlan p = plan();
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
significant_bits = 12
pulse_width_us = {}
sync_line = "octascope-sync"
seat = false
[controls]
keyboards = ["046d:c31c"]
)",
      p.samples, p.a_scans, p.fly_back_lines, p.b_scans, p.line_rate_hz, p.a_spacing_um,
      p.b_spacing_um, pulse_width_us);
  return {};
}

void Theatre::scan(std::stop_token stop) {
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
bool Theatre::wait_for_pulse(std::stop_token stop) {
  while (!stop.stop_requested()) {
    if (chip_->level(trigger_line))
      return true;
    clock_.sleep_for(500us);
  }
  return false;
}

// One edge up; in vain while the plug is pulled.
void Theatre::answer() {
  static_cast<void>(chip_->pull(sync_line, true));
  static_cast<void>(chip_->pull(sync_line, false));
}

void Theatre::sweep(hal::TimePoint pulse) {
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
