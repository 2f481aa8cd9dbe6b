// The devices of a run, real ones and twins, and what the line camera's spectra are.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/real_devices.h"
#include "firmware-host/devices/twins.h"
#include "hal/clock.h"
#include "hal/control_input.h"
#include "hal/display.h"
#include "hal/galvo_trigger.h"
#include "hal/line_camera.h"
#include "hal/result.h"
#include "hal/scope_camera.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/scan/scan_plan.h"
#include "ui/layout/scan_field.h"

namespace octascope::firmware_host {

// Each device is either the real one or, where that is null, its twin.
class Devices {
public:
  // The display alone, so that something can be shown while the rest is made. `real` is what the
  // choices were made from. No real device is opened by this or the functions below.
  Devices(std::unique_ptr<RealDevices> real, const DeviceChoices& choices, hal::Clock& clock);

  // What is present now, as RealDevices::find_for(); only before make_others().
  DetectedDevices find_again(const RunOptions& options) { return real_->find_for(options); }

  // Makes all other devices: reads the twins' files and makes their loop.
  hal::Result<> make_others(const DeviceChoices& choices, const RunOptions& options,
                            const Configuration& configuration, hal::Clock& clock);

  // For a replay, instead of make_others(): pedal and knob only. There are then no cameras and no
  // trigger; do not ask about them or the plan.
  hal::Result<> make_controls(const DeviceChoices& choices, const RunOptions& options,
                              const Configuration& configuration, hal::Clock& clock);

  hal::LineCamera& line_camera() const {
    return line_camera_ ? *line_camera_ : *twins_.line_camera;
  }
  hal::GalvoTrigger& galvo_trigger() const {
    return galvo_trigger_ ? *galvo_trigger_ : *twins_.galvo_trigger;
  }
  hal::ControlInput& control_input() const {
    return control_input_ ? *control_input_ : *twins_.control_input;
  }
  // Null if there is none: recordings have none, and no twin serves beside a real line camera.
  hal::ScopeCamera* scope_camera() const {
    return scope_camera_ ? scope_camera_.get() : twins_.scope_camera.get();
  }
  hal::Display& display() const { return display_ ? *display_ : *offscreen_; }

  const pipeline::ScanPlan& plan() const { return plan_; }
  const pipeline::Calibration& calibration() const { return calibration_; }
  const hal::LineFormat& format() const { return format_; }
  hal::LineCameraConfig camera_config() const;          // for the plan
  const std::string& source() const { return source_; } // for people: what is imaged
  const std::optional<ui::ScanField>& scan_field() const { return twins_.scan_field; }

  // Whether any part of the picture is not the patient's.
  bool simulated() const;

  // For keys that stand in for the pedal; null: the real pedal serves.
  sim::SimControlInput* simulated_controls() const {
    return control_input_ ? nullptr : twins_.control_input.get();
  }

  // As RealDevices::new_control_profile().
  std::optional<ui::ControlProfile> new_control_profile() { return real_->new_control_profile(); }

  // As RealDevices::new_keyboard_complaint().
  std::optional<std::string> new_keyboard_complaint() { return real_->new_keyboard_complaint(); }

  // As RealDevices::new_missed_answers().
  std::uint64_t new_missed_answers() { return real_->new_missed_answers(); }

  // As RealDevices::make_trigger_safe().
  void make_trigger_safe() noexcept { real_->make_trigger_safe(); }

  // Starts the fault script's clock.
  void start_faults(hal::TimePoint now) { twins_.faults->start(now); }
  void apply_faults(hal::TimePoint now) { twins_.apply_faults(now, offscreen_.get()); }

private:
  void make_display(const DeviceChoice& choice, hal::Clock& clock);
  hal::Result<> make_simulated_spectra(const RunOptions& options,
                                       const Configuration& configuration, hal::Clock& clock);
  hal::Result<> make_real_spectra(const DeviceChoices& choices, const RunOptions& options,
                                  const Configuration& configuration, hal::Clock& clock);

  std::unique_ptr<RealDevices> real_; // borrowed by the devices it made
  Twins twins_;
  std::unique_ptr<hal::LineCamera> line_camera_;
  std::unique_ptr<hal::GalvoTrigger> galvo_trigger_;
  std::unique_ptr<hal::ControlInput> control_input_;
  std::unique_ptr<hal::ScopeCamera> scope_camera_;
  std::unique_ptr<hal::Display> display_;
  std::unique_ptr<sim::OffscreenDisplay> offscreen_;
  pipeline::ScanPlan plan_;
  pipeline::Calibration calibration_;
  hal::LineFormat format_;
  std::string source_;
};

// The picture's size: from the command line, else from the configuration.
hal::DisplayConfig display_config(const RunOptions& options, const Configuration& configuration);

} // namespace octascope::firmware_host
