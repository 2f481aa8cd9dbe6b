// What is known of a commissioning, kept in its folder after each step.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "firmware-host/commands/commission/dialogue.h"
#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/clock.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// What a step found.
struct StepRecord {
  std::vector<std::pair<std::string, std::string>> found; // what, and its value with unit
  std::vector<std::string> warnings;
  std::vector<std::string> pictures; // PNG files in the folder
};

// Bound to one thread.
class Session {
public:
  // Opens the folder, or makes it. ErrorCode::bad_data: something else's folder, or a damaged
  // state; invalid_argument: it was begun with other devices.
  static hal::Result<Session> open(const std::filesystem::path& folder, bool simulate);

  bool simulated() const { return simulate_; }
  const std::filesystem::path& folder() const { return folder_; }

  // Values that later steps need; they last if the step that sets them is kept.
  std::string text(std::string_view key, std::string_view fallback = {}) const;
  double number(std::string_view key, double fallback) const;
  void set(std::string_view key, nlohmann::ordered_json value);
  void unset(std::string_view key);

  // Of a step: empty (never done), "done" or "skipped".
  std::string outcome(std::string_view step) const;
  StepRecord record(std::string_view step) const;
  // Of a step that is done: the step whose newer result it lacks, its own or that of a step that it
  // is made of (step_order.h). Empty: none, it is up to date.
  std::string outdated_by(std::string_view step) const;
  // Why the last attempt at the step failed; empty: it did not.
  std::string failure(std::string_view step) const;
  // Keeps the step with all values set since the last keep(), fail() or skip().
  hal::Result<> keep(std::string_view step, const StepRecord& record);
  // Forget what was set since then.
  hal::Result<> fail(std::string_view step, std::string_view why);
  hal::Result<> skip(std::string_view step);
  void forget();

  // A file that is not there yet: "dark.h5", else "dark-2.h5" …
  std::filesystem::path free_file(std::string_view stem, std::string_view extension) const;
  // The file that a value names; empty: none.
  std::optional<std::filesystem::path> file(std::string_view key) const;

  // The configuration as known so far. Paths are relative to the folder.
  std::string configuration_toml() const;
  // Written to working.toml and read back: what captures and looks run with. `phantom`: what the
  // twin looks at.
  hal::Result<RunOptions> run_options(std::string_view phantom) const;
  hal::Result<Configuration> configuration() const;

private:
  Session(std::filesystem::path folder, bool simulate)
      : folder_(std::move(folder)), simulate_(simulate) {}
  hal::Result<> save() const;
  int revision(std::string_view step) const;

  std::filesystem::path folder_;
  bool simulate_;
  nlohmann::ordered_json state_;  // as in commission.json
  nlohmann::ordered_json values_; // with those not kept yet
};

} // namespace octascope::firmware_host
