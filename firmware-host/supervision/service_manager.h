// The protocol between systemd and the program: folders, readiness, watchdog.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "hal/clock.h"

namespace octascope::firmware_host {

// Where a service may write: $STATE_DIRECTORY and $RUNTIME_DIRECTORY, as systemd sets them for a
// unit. Empty: no folder, and nothing is written.
struct ServiceFolders {
  std::optional<std::filesystem::path> state;
  std::optional<std::filesystem::path> runtime;
};
ServiceFolders service_folders();

// Whether stderr goes to the journal: $JOURNAL_STREAM must name stderr's own device and inode, as
// sd_journal documents, so that redirected output is text.
bool stderr_is_journal();

// Notifies systemd; silent if $NOTIFY_SOCKET is not set. One thread at a time.
class ServiceManager {
public:
  ServiceManager();

  // The unit's WatchdogSec, if set and meant for this process.
  std::optional<hal::Duration> watchdog_interval() const { return watchdog_interval_; }

  // Whether systemd started this process and waits for ready().
  bool there() const { return there_; }

  // A step towards the picture begins; it may take as long as the whole start otherwise could.
  void starting(std::string_view step) const;
  void ready() const; // there is a picture
  // Sets the watchdog's timeout from now on, if there is one.
  void set_watchdog(hal::Duration interval) const;
  void kick() const;     // the watchdog
  void stopping() const; // in good order
  void status(const std::string& line) const;

private:
  bool there_;
  std::optional<hal::Duration> watchdog_interval_;
};

} // namespace octascope::firmware_host
