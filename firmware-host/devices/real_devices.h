// Finds the real devices and makes them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/configuration/device_config.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/devices/detected_devices.h"
#include "firmware-host/devices/device_choice.h"
#include "hal/clock.h"
#include "hal/control_input.h"
#include "hal/display.h"
#include "hal/galvo_trigger.h"
#include "hal/line_camera.h"
#include "hal/linux/gpio/gpio_galvo_trigger.h"
#include "hal/linux/hid/controls/hid_controls.h"
#include "hal/linux/hid/keyboards/console_keyboards.h"
#include "hal/linux/libcamera/libcamera_session.h"
#include "hal/result.h"
#include "hal/scope_camera.h"
#include "pipeline/scan/scan_plan.h"
#include "ui/controls/control_profile.h"

namespace octascope::firmware_host {

// Asks once and remembers; make another to ask again. What it makes borrows from it.
class RealDevices {
public:
  // `plan` sets which frames a line camera has to deliver. `clock` outlives this.
  RealDevices(DeviceConfig config, const pipeline::ScanPlan& plan, hal::Clock& clock);

  // Looks for all devices.
  DetectedDevices find();

  // Looks only for what decides a run: the display alone if all else is simulated. libcamera, which
  // is slow, is asked only beside a real line camera, and not if its camera is explicitly
  // requested.
  DetectedDevices find_for(const RunOptions& options);

  // The line camera alone.
  DeviceFinding find_line_camera();

  // The line camera's frame format: the offered one if a camera is found, else the requested one.
  hal::LineFormat line_format() const { return format_; }

  // `counts_matter`: the calibration holds counts of the camera's own, so that one of another depth,
  // which came after all was set up, must not serve.
  std::unique_ptr<hal::LineCamera> make_line_camera(bool counts_matter);
  std::unique_ptr<hal::GalvoTrigger> make_galvo_trigger();
  std::unique_ptr<hal::ControlInput> make_control_input();
  hal::Result<std::unique_ptr<hal::ScopeCamera>> make_scope_camera();
  std::unique_ptr<hal::Display> make_display();

  // The leading control's profile, returned once whenever another control takes the lead; the
  // default profile if it has none of its own or there is no control.
  std::optional<ui::ControlProfile> new_control_profile();

  // Why a configured keyboard cannot be read at the console; returned once.
  std::optional<std::string> new_keyboard_complaint();

  // Pulses not answered by the scanner on its sync line since the last call.
  std::uint64_t new_missed_answers();

  // Sets the trigger's line to its safe level if a real one is held. Async-signal-safe.
  void make_trigger_safe() noexcept;

private:
  DeviceFinding find_genicam(const hal::linux_backend::GenicamAddress& address);
  std::vector<hal::LineFormat> formats_to_try() const;
  DeviceFinding find_galvo_trigger() const;
  DeviceFinding find_control_input() const;
  DeviceFinding find_scope_camera();
  DeviceFinding find_console_display() const;
  hal::Result<> start_libcamera();
  std::vector<std::string> taken_nodes() const;

  const DeviceConfig config_;
  hal::Clock& clock_;
  hal::LineFormat format_;
  std::string line_node_; // of the line camera; empty: none found yet
  std::unique_ptr<hal::linux_backend::LibcameraSession> libcamera_;
  hal::linux_backend::GpioGalvoTrigger* trigger_ = nullptr; // made here, owned by the caller
  std::uint64_t missed_answers_ = 0;
  const hal::linux_backend::HidControls* controls_ = nullptr;       // likewise
  std::uint64_t control_changes_ = 0;                               // already reported
  const hal::linux_backend::ConsoleKeyboards* keyboards_ = nullptr; // likewise
  std::string keyboard_complaint_;                                  // already reported
};

// What `octascope run` would choose with these options, with every device looked for; an Error if
// it would refuse the configuration.
hal::Result<DeviceChoices> choices_of_run(const RunOptions& options, hal::Clock& clock);

} // namespace octascope::firmware_host
