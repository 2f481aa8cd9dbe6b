// Saves the settings made by pedal and knob, beside the running display.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "firmware-host/configuration/kept/settings.h"
#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/background_task.h"

namespace octascope::firmware_host {

// Bound to the render thread; a thread of its own writes, one file at a time.
class SettingsStore {
public:
  // `clock` and `faults` outlive it.
  SettingsStore(std::filesystem::path file, hal::Clock& clock, pipeline::FaultLog& faults)
      : file_{std::move(file)}, clock_{clock}, faults_{faults} {}

  // Restores an earlier run's settings; empty if there is no file. An unreadable file is renamed
  // and recorded as a fault (settings_broken); it never prevents a start.
  std::optional<RestoredView> restore(const ConfiguredView& configured);

  // Whether restore() has just set a file aside.
  bool was_broken() const { return was_broken_; }

  // Call every turn: costs next to nothing, and some microseconds every two seconds, when changes
  // are written. A failed write is retried after half a minute.
  void note(const ConfiguredView& configured, const ui::ViewState& state);

  // At the end: writes what is not written yet.
  void finish(const ConfiguredView& configured, const ui::ViewState& state);

private:
  void take_written();
  void write(std::string text);

  std::filesystem::path file_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  bool was_broken_ = false;
  hal::TimePoint next_{};
  std::optional<std::string> kept_; // content of the file; empty: unknown
  std::string writing_text_;        // content being written
  pipeline::BackgroundTask<hal::Result<>> writing_;
};

} // namespace octascope::firmware_host
