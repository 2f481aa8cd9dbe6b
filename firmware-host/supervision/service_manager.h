// What systemd and the program tell each other: folders, readiness, watchdog.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "hal/clock.h"

namespace octascope::firmware_host {

// Where a service may write: $STATE_DIRECTORY and $RUNTIME_DIRECTORY, as systemd sets them for a
// unit. Empty: nobody gave a folder, and nothing is written there.
struct ServiceFolders {
  std::optional<std::filesystem::path> state;
  std::optional<std::filesystem::path> runtime;
};
ServiceFolders service_folders();

// Does stderr go to the journal? As sd_journal says it: $JOURNAL_STREAM names stderr's own device
// and inode, so that somebody who redirects it gets text.
bool stderr_is_journal();

// Tells systemd; silent where $NOTIFY_SOCKET names none. One thread at a time.
class ServiceManager {
public:
  ServiceManager();

  // The unit's WatchdogSec, if it has one and it is meant for this process.
  std::optional<hal::Duration> watchdog_interval() const { return watchdog_interval_; }

  // Did systemd start this process, and does it wait for ready()?
  bool there() const { return there_; }

  // A step on the way to the picture begins: it may take as long as the whole start otherwise.
  void starting(std::string_view step) const;
  void ready() const; // the picture is there
  // Where there is a watchdog, it waits so long from now on.
  void set_watchdog(hal::Duration interval) const;
  void kick() const;     // the watchdog
  void stopping() const; // in good order
  void status(const std::string& line) const;

private:
  bool there_;
  std::optional<hal::Duration> watchdog_interval_;
};

} // namespace octascope::firmware_host
