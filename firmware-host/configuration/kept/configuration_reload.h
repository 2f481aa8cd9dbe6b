// Reloads a configuration beside the running display.
#pragma once

#include <filesystem>
#include <optional>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/configuration_bundle.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/threads/background_task.h"
#include "ui/controls/control_profile.h"

namespace octascope::firmware_host {

// Everything a running appliance can take over at once, and whether it may.
struct ReadConfiguration {
  Configuration configuration;
  ui::ControlProfile controls;
  std::optional<ConfigurationBundle> calibration; // with its tables, for comparison; empty: none
};

// Validates the configuration as a whole, with every file that it names.
hal::Result<ReadConfiguration> read_whole(const std::filesystem::path& file,
                                          const RunOptions& options);

// Bound to one thread; reads on a thread of its own.
class ConfigurationReload {
public:
  // Editors often write a file twice, or several files in a row.
  static constexpr hal::Duration settled_after = std::chrono::milliseconds{300};

  ConfigurationReload(std::filesystem::path file, RunOptions options)
      : file_{std::move(file)}, options_{std::move(options)} {}

  // Call when the file was written.
  void ask(hal::TimePoint now) { asked_ = now; }

  // Starts reading once writes have settled; returns each outcome once.
  std::optional<hal::Result<ReadConfiguration>> take(hal::TimePoint now);

private:
  std::filesystem::path file_;
  RunOptions options_;
  std::optional<hal::TimePoint> asked_;
  pipeline::BackgroundTask<hal::Result<ReadConfiguration>> reading_;
};

} // namespace octascope::firmware_host
