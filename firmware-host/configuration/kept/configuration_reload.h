// Reads a configuration anew beside the running display.
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

// Everything that a running appliance can take over at once, and whether it may.
struct ReadConfiguration {
  Configuration configuration;
  ui::ControlProfile controls;
  std::optional<ConfigurationBundle> calibration; // with its tables, to be compared; empty: none
};

// Validated as a whole, with every file that it names.
hal::Result<ReadConfiguration> read_whole(const std::filesystem::path& file,
                                          const RunOptions& options);

// Bound to one thread; a thread of its own reads.
class ConfigurationReload {
public:
  // Whoever writes a file often writes it twice, or another one with it.
  static constexpr hal::Duration settled_after = std::chrono::milliseconds{300};

  ConfigurationReload(std::filesystem::path file, RunOptions options)
      : file_{std::move(file)}, options_{std::move(options)} {}

  // It was written just now.
  void ask(hal::TimePoint now) { asked_ = now; }

  // Begins to read when it has settled; the outcome, once each time.
  std::optional<hal::Result<ReadConfiguration>> take(hal::TimePoint now);

private:
  std::filesystem::path file_;
  RunOptions options_;
  std::optional<hal::TimePoint> asked_;
  pipeline::BackgroundTask<hal::Result<ReadConfiguration>> reading_;
};

} // namespace octascope::firmware_host
