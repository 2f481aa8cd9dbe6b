// An operating theatre without hardware: everything that the appliance is connected to, through
// the kernel's own drivers. A line camera (v4l2loopback) that a feeder fills with a phantom's
// spectra whenever the scanner's trigger line (gpio-sim) is pulsed, which the scanner answers on
// its sync line, a foot pedal (uhid), a microscope camera (vimc) and a monitor (vkms); and the
// configuration of an appliance that stands in it.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "hal/linux/monotonic_clock.h"
#include "hal/result.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/spectra/spectra_source.h"
#include "tests/virtual_hardware/support/loopback_feeder.h"
#include "tests/virtual_hardware/support/sim_gpio_chip.h"
#include "tests/virtual_hardware/support/virtual_keyboard.h"
#include "tests/virtual_hardware/support/virtual_pedal.h"

namespace octascope::tests {

// Why there can be none here; empty when there can.
std::string virtual_rig_missing();

// A phantom, an eye mostly, made when it is asked for; or one volume of that, written and read again: for kernels in
// which a second of work is a second of somebody's start. 16-bit samples, [sweep][line][sample].
hal::Result<std::unique_ptr<sim::SpectraSource>>
virtual_rig_phantom(int volumes, const std::string& phantom = "anterior_eye");
hal::Result<> write_virtual_rig_spectra(const std::filesystem::path& file);
hal::Result<std::unique_ptr<sim::SpectraSource>>
read_virtual_rig_spectra(const std::filesystem::path& file);

enum class VirtualRigStart : std::uint8_t {
  by_hand, // devices are what is found at the start, and no manager of seats runs
  at_boot, // cameras are waited for, and the monitor is the seat manager's to give
};

// octascope.toml, which lists one keyboard, and the calibration that it names; the folder is made.
hal::Result<> write_virtual_rig_configuration(const std::filesystem::path& folder,
                                              VirtualRigStart start);

// Threads: one at a time; the scanner and the camera work in a thread of their own.
class VirtualRig {
public:
  // What one processor without a GPU can carry: 1.2 volumes a second, 3750 lines a second. A frame may come half
  // a sweep late, 17 ms, and the bench's kernel lets nobody run for 7 of them at times.
  static pipeline::ScanPlan plan();

  // Makes every device; the scanner waits for its first pulse. The camera sees the spectra, whose
  // sweeps are of the plan.
  static hal::Result<std::unique_ptr<VirtualRig>> make(std::unique_ptr<sim::SpectraSource> spectra);
  ~VirtualRig();

  SimGpioChip& chip() { return *chip_; }

  // Pulled out and plugged in.
  void pull_pedal() { pedal_.reset(); }
  hal::Result<> plug_pedal();
  // The centre switch and its neighbours, as the real device's report: pressed, or 0 for released.
  hal::Result<> tread(std::uint8_t switches) { return pedal_->send({switches, 0}); }

  // Plugged in by those who need one; the second kind is not listed.
  static hal::Result<std::unique_ptr<VirtualKeyboard>> plug_keyboard();
  static hal::Result<std::unique_ptr<VirtualKeyboard>> plug_strange_keyboard();

  // Another thing under the beam, from the next volume on. Waits until no sweep is under way.
  void look_at(std::unique_ptr<sim::SpectraSource> spectra);

  // While it is blind, pulses go by and no frame comes, as from a camera without light or cable.
  void blind_camera(bool blind) { blind_ = blind; }

  // While it is mute, the scanner scans as ever and answers no pulse on its sync line.
  void mute_scanner(bool mute) { mute_ = mute; }

  std::uint64_t pulses() const { return pulses_; }
  std::uint64_t frames() const { return frames_; }

private:
  VirtualRig() = default;
  void scan(std::stop_token stop);
  bool wait_for_pulse(std::stop_token stop);
  void answer();
  void sweep(hal::TimePoint pulse);

  hal::linux_backend::MonotonicClock clock_;
  std::mutex spectra_mutex_;
  std::unique_ptr<sim::SpectraSource> spectra_;
  std::unique_ptr<SimGpioChip> chip_;
  std::unique_ptr<LoopbackFeeder> feeder_;
  std::unique_ptr<VirtualPedal> pedal_;
  std::atomic<bool> blind_{false}, mute_{false};
  std::atomic<std::uint64_t> pulses_{0}, frames_{0};
  std::uint64_t volume_ = 0;
  std::jthread scanner_; // last: it uses all of the above
};

} // namespace octascope::tests
