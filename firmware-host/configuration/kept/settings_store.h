// Keeps what pedal and knob have set, beside the running display.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "firmware-host/configuration/kept/settings.h"
#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/background_task.h"

namespace octascope::firmware_host {

// Bound to one thread, the render thread; a thread of its own writes, one file at a time.
class SettingsStore {
public:
  // `clock` and `faults` outlive it.
  SettingsStore(std::filesystem::path file, hal::Clock& clock, pipeline::FaultLog& faults)
      : file_{std::move(file)}, clock_{clock}, faults_{faults} {}

  // Of an earlier run; nothing where there is no file. One that cannot be read is set aside under
  // another name, recorded as a fault (settings_broken), and never stops a start.
  std::optional<RestoredView> restore(const ConfiguredView& configured);

  // restore() has just set one aside.
  bool was_broken() const { return was_broken_; }

  // Every turn: costs next to nothing, and every two seconds some microseconds. What changed is
  // written then; a file that cannot be written is tried again half a minute later.
  void note(const ConfiguredView& configured, const ui::ViewState& state);

  // At the end: what was not written yet, now.
  void finish(const ConfiguredView& configured, const ui::ViewState& state);

private:
  void take_written();
  void write(std::string text);

  std::filesystem::path file_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  bool was_broken_ = false;
  hal::TimePoint next_{};
  std::optional<std::string> kept_; // what the file holds; empty: not known
  std::string writing_text_;        // what it will hold
  pipeline::BackgroundTask<hal::Result<>> writing_;
};

} // namespace octascope::firmware_host
