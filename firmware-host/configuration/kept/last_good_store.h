// Determines when a configuration has proved itself, and keeps it.
#pragma once

#include <filesystem>
#include <optional>

#include "firmware-host/configuration/kept/last_good.h"
#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/background_task.h"

namespace octascope::firmware_host {

// Bound to one thread; reads and writes on threads of its own.
class LastGoodStore {
public:
  // A run of this length without a picture proves a configuration, too: the scanner may be switched
  // on later.
  static constexpr hal::Duration proved_after = std::chrono::seconds{10};

  // `clock` and `faults` outlive it.
  LastGoodStore(std::filesystem::path state_folder, hal::Clock& clock, pipeline::FaultLog& faults)
      : folder_{std::move(state_folder)}, clock_{clock}, faults_{faults} {}

  // This file is used from now on. It is read at once, since it may be edited later.
  void begin(const std::filesystem::path& configuration);

  // Call every turn. Writes what was read at the first picture of a volume since begin(), or after
  // `proved_after`. A failure is a fault (configuration_not_kept).
  void advance(bool picture_shown);

  // At the end of a run, which may be shorter than the reading: waits for it.
  void finish(bool picture_shown);

private:
  void read_wanted();
  bool is_proved(bool picture_shown) const;

  LastGood folder_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  hal::TimePoint began_{};
  std::optional<std::filesystem::path> wanted_; // to be read after the present one
  pipeline::BackgroundTask<hal::Result<ConfigurationBundle>> reading_;
  pipeline::BackgroundTask<hal::Result<>> writing_;
};

} // namespace octascope::firmware_host
