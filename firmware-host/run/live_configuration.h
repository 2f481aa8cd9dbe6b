// The configuration while the appliance runs: kept when it has proved itself, read anew when it is
// written, with the settings of pedal and knob over it, and told on the screen.
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
  // `chosen` is what the run begins with. Without a `state_folder` nothing is kept. `clock` and
  // `faults` outlive it.
  LiveConfiguration(const ChosenConfiguration& chosen, const RunOptions& options,
                    const std::optional<std::filesystem::path>& state_folder, hal::Clock& clock,
                    pipeline::FaultLog& faults);

  // What the view begins with, by the configuration and by what was kept of an earlier run.
  void configure(RenderLoopSetup& setup);

  // From now on changes are followed.
  void follow(std::unique_ptr<ConfigurationWatch> watch);

  // The leading device's profile, which serves where the configuration names none.
  void lead_with(ui::ControlProfile profile, RenderLoop& loop);

  // Every turn.
  void advance(RenderLoop& loop);
  // At the end: what was set is kept.
  void finish(RenderLoop& loop);

  ui::ConfigurationState state() const { return chosen_.state; }

  // One line for the surgeon while there is something to say; empty: nothing.
  std::string_view notice() const { return said_ ? *said_ : standing_; }

private:
  void take_over(ReadConfiguration read, RenderLoop& loop);
  void refuse(const std::string& reason);
  void change_live(ReadConfiguration& read, RenderLoop& loop);
  std::vector<std::string> waits_for_restart(const ReadConfiguration& read) const;
  void say(std::string words, hal::Duration shown_for);
  ConfiguredView configured_view(const RenderLoop& loop) const;

  ChosenConfiguration chosen_;
  const Configuration started_; // what cannot be changed in a running appliance is as it has it
  Configuration used_;          // what can is as this has it
  const RunOptions options_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  std::optional<ConfigurationBundle> started_calibration_;
  std::optional<ui::ControlProfile> device_profile_;
  std::optional<LastGoodStore> last_good_;
  std::uint64_t displayed_before_ = 0; // volumes, when the configuration in use began
  std::optional<SettingsStore> settings_;
  std::unique_ptr<ConfigurationWatch> watch_;
  std::optional<ConfigurationReload> reload_;
  std::string standing_;            // for as long as it holds
  std::optional<std::string> said_; // for a while, before it
  hal::TimePoint said_until_{};
};

} // namespace octascope::firmware_host
