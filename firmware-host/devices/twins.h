// The simulated devices of a run and their faults.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/devices/galvo_link.h"
#include "sim/devices/offscreen_display.h"
#include "sim/devices/sim_control_input.h"
#include "sim/devices/sim_galvo_trigger.h"
#include "sim/devices/sim_line_camera.h"
#include "sim/devices/sim_scope_camera.h"
#include "sim/faults/fault_schedule.h"
#include "sim/spectra/spectra_source.h"
#include "ui/layout/scan_field.h"

namespace octascope::firmware_host {

// Members are ordered by dependency. With a real line camera, those from `plan` on are empty but
// for `faults` and `control_input`.
struct Twins {
  pipeline::ScanPlan plan;
  pipeline::Calibration calibration;
  hal::LineFormat format;
  std::string source; // for people: what is imaged, and how long its loop is

  std::unique_ptr<sim::FaultSchedule> faults; // empty without --faults
  std::unique_ptr<sim::SpectraSource> spectra;
  std::unique_ptr<sim::GalvoLink> link;
  std::unique_ptr<sim::SimLineCamera> line_camera;
  std::unique_ptr<sim::SimGalvoTrigger> galvo_trigger;
  std::unique_ptr<sim::SimControlInput> control_input;
  std::unique_ptr<sim::SimScopeCamera> scope_camera; // null for a recording, which has no
                                                     // microscope picture
  std::optional<ui::ScanField> scan_field;

  // Whether the fault script affects the display.
  bool concern_display() const;

  // Scope camera and display know only "unplugged" and "plugged in": this sets it. Call at every
  // turn of the render loop.
  void apply_faults(hal::TimePoint now, sim::OffscreenDisplay* display);
};

// The refractive index for which the plan's depths hold: the calibration's if they come from it,
// else unknown. Pure.
std::optional<double> medium_of(const pipeline::ScanPlan& plan,
                                const pipeline::Calibration& calibration);

// What is needed even without a simulated line camera: the fault script, and the pedal with its
// script.
hal::Result<Twins> make_script_twins(const RunOptions& options, const Configuration& configuration,
                                     hal::Clock& clock);

// Reads the recording or makes the phantom, and reads the calibration and the scripts that the
// options name.
hal::Result<Twins> make_twins(const RunOptions& options, const Configuration& configuration,
                              hal::Clock& clock);

} // namespace octascope::firmware_host
