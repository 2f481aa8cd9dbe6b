// The configuration while the appliance runs: kept once it has proved itself, reloaded when its
// file is written, overlaid with the settings of pedal and knob, and reported on the screen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "firmware-host/configuration/kept/configuration_choice.h"
#include "firmware-host/configuration/kept/configuration_reload.h"
#include "firmware-host/configuration/kept/configuration_watch.h"
#include "firmware-host/configuration/kept/last_good_store.h"
#include "firmware-host/configuration/kept/settings_store.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/run/render_loop.h"
#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "ui/controls/control_profile.h"

namespace octascope::firmware_host {

// Bound to the render thread; files are read and written on threads of their own.
class LiveConfiguration {
public:
  // `chosen` is the initial configuration. Without a `state_folder` nothing is kept. `clock` and
  // `faults` outlive it.
  LiveConfiguration(const ChosenConfiguration& chosen, const RunOptions& options,
                    const std::optional<std::filesystem::path>& state_folder, hal::Clock& clock,
                    pipeline::FaultLog& faults);

  // Sets the initial view, from the configuration and the settings of an earlier run.
  void configure(RenderLoopSetup& setup);

  // Follows changes from now on.
  void follow(std::unique_ptr<ConfigurationWatch> watch);

  // Sets the leading device's profile, which applies where the configuration names none.
  void lead_with(ui::ControlProfile profile, RenderLoop& loop);

  // Call every turn.
  void advance(RenderLoop& loop);
  // Call at the end: saves the settings.
  void finish(RenderLoop& loop);

  ui::ConfigurationState state() const { return chosen_.state; }

  // One line for the surgeon; empty: nothing to say.
  std::string_view notice() const { return said_ ? *said_ : standing_; }

private:
  void take_over(ReadConfiguration read, RenderLoop& loop);
  void refuse(const std::string& reason);
  void change_live(ReadConfiguration& read, RenderLoop& loop);
  std::vector<std::string> waits_for_restart(const ReadConfiguration& read) const;
  void say(std::string words, hal::Duration shown_for);
  ConfiguredView configured_view(const RenderLoop& loop) const;

  ChosenConfiguration chosen_;
  const Configuration started_; // what needs a restart is as in this one
  Configuration used_;          // what can change is as in this one
  const RunOptions options_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  std::optional<ConfigurationBundle> started_calibration_;
  std::optional<ui::ControlProfile> device_profile_;
  std::optional<LastGoodStore> last_good_;
  std::uint64_t displayed_before_ = 0; // volumes displayed before the configuration in use began
  std::optional<SettingsStore> settings_;
  std::unique_ptr<ConfigurationWatch> watch_;
  std::optional<ConfigurationReload> reload_;
  std::string standing_;            // shown as long as it holds
  std::optional<std::string> said_; // shown for a while, instead of it
  hal::TimePoint said_until_{};
};

} // namespace octascope::firmware_host
