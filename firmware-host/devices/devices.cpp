#include "firmware-host/devices/devices.h"

#include <algorithm>

#include "hal/linux/window_display.h"

namespace octascope::firmware_host {

namespace {

bool is_calibrated(const RunOptions& options, const Configuration& configuration) {
  return options.calibration || configuration.calibration;
}

// Of a real line camera: what the configuration says, and nothing but that.
hal::Result<pipeline::Calibration> real_calibration(const RunOptions& options,
                                                    const Configuration& configuration,
                                                    const pipeline::ScanPlan& plan) {
  const auto& file = options.calibration ? options.calibration : configuration.calibration;
  if (!file)
    return pipeline::Calibration::identity(plan.samples);
  return pipeline::Calibration::load(*file, plan.samples);
}

} // namespace

Devices::Devices(std::unique_ptr<RealDevices> real, const DeviceChoices& choices, hal::Clock& clock)
    : real_{std::move(real)} {
  make_display(choices.display, clock);
}

hal::Result<> Devices::make_others(const DeviceChoices& choices, const RunOptions& options,
                                   const Configuration& configuration, hal::Clock& clock) {
  HAL_CHECK(is_camera_backend(choices.line_camera.backend)
                ? make_real_spectra(choices, options, configuration, clock)
                : make_simulated_spectra(options, configuration, clock));
  if (choices.control_input.backend == "hid")
    control_input_ = real_->make_control_input();
  if (display_ && twins_.concern_display())
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--faults: only an offscreen display can be made to fail; display faults need "
                     "--display offscreen");
  return {};
}

hal::Result<> Devices::make_controls(const DeviceChoices& choices, const RunOptions& options,
                                     const Configuration& configuration, hal::Clock& clock) {
  HAL_TRY(auto twins, make_script_twins(options, configuration, clock));
  twins_ = std::move(twins);
  if (choices.control_input.backend == "hid")
    control_input_ = real_->make_control_input();
  return {};
}

void Devices::make_display(const DeviceChoice& choice, hal::Clock& clock) {
  if (choice.backend == "offscreen")
    offscreen_ = std::make_unique<sim::OffscreenDisplay>(clock);
  else if (choice.backend == "window")
    display_ = std::make_unique<hal::linux_backend::WindowDisplay>(clock);
  else
    display_ = real_->make_display();
}

hal::Result<> Devices::make_simulated_spectra(const RunOptions& options,
                                              const Configuration& configuration,
                                              hal::Clock& clock) {
  HAL_TRY(auto twins, make_twins(options, configuration, clock));
  twins_ = std::move(twins);
  plan_ = twins_.plan;
  calibration_ = twins_.calibration;
  format_ = twins_.format;
  source_ = twins_.source;
  return {};
}

hal::Result<> Devices::make_real_spectra(const DeviceChoices& choices, const RunOptions& options,
                                         const Configuration& configuration, hal::Clock& clock) {
  HAL_TRY(auto twins, make_script_twins(options, configuration, clock));
  twins_ = std::move(twins);
  plan_ = plan_of(options, configuration);
  HAL_TRY(auto calibration, real_calibration(options, configuration, plan_));
  calibration_ = std::move(calibration);
  if (is_calibrated(options, configuration) && !configuration.depth_spacing_said) {
    plan_.depth_spacing_um = calibration_.depth_spacing_um;
    plan_.assumed_spacings.depth = calibration_.assumed_spacings.depth;
  }
  plan_.refractive_index = medium_of(plan_, calibration_);
  plan_.zero_padding = calibration_.zero_padding;
  format_ = real_->line_format();
  source_ = is_calibrated(options, configuration) ? "line camera" : "line camera, not calibrated";
  line_camera_ =
      real_->make_line_camera(calibration_.background_mode == pipeline::BackgroundMode::file);
  if (choices.galvo_trigger.backend == "gpio") {
    galvo_trigger_ = real_->make_galvo_trigger();
  } else if (line_camera_->simulated()) { // it runs free: the pulses only say where volumes begin
    twins_.link = std::make_unique<sim::GalvoLink>(plan_.sweep_duration());
    twins_.galvo_trigger =
        std::make_unique<sim::SimGalvoTrigger>(*twins_.link, clock, twins_.faults.get());
  } else {
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "[devices] galvo_trigger is \"sim\" beside a real line camera: nothing would "
                     "trigger the scanner; expected \"auto\" or \"gpio\"");
  }
  if (choices.scope_camera.backend == "libcamera") {
    HAL_TRY(auto scope, real_->make_scope_camera());
    scope_camera_ = std::move(scope);
  }
  return plan_.validate();
}

bool Devices::simulated() const {
  const hal::ScopeCamera* scope = scope_camera();
  return line_camera().simulated() || (scope != nullptr && scope->simulated());
}

// The workers may fall behind by a volume and a sixth of it. Many drivers have no more than 512
// buffers.
hal::LineCameraConfig Devices::camera_config() const {
  return {.format = format_,
          .line_rate_hz = plan_.line_rate_hz,
          .buffers = std::clamp(plan_.sweeps() * 7 / 6, 96, 512)};
}

hal::DisplayConfig display_config(const RunOptions& options, const Configuration& configuration) {
  hal::DisplayConfig config;
  config.width = options.size ? (*options.size)[0] : configuration.width;
  config.height = options.size ? (*options.size)[1] : configuration.height;
  config.fullscreen = configuration.fullscreen;
  return config;
}

} // namespace octascope::firmware_host
