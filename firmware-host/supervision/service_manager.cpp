#include "firmware-host/supervision/service_manager.h"

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>
#include <sys/stat.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

namespace octascope::firmware_host {

using namespace std::chrono_literals;

namespace {

// Of several folders that a unit may have, the first.
std::optional<std::filesystem::path> folder_of(const char* variable) {
  const char* const value = std::getenv(variable);
  const std::string_view first = std::string_view{value == nullptr ? "" : value};
  if (first.empty() || first.front() == ':')
    return std::nullopt;
  return std::filesystem::path{first.substr(0, first.find(':'))};
}

} // namespace

ServiceFolders service_folders() {
  return {folder_of("STATE_DIRECTORY"), folder_of("RUNTIME_DIRECTORY")};
}

bool stderr_is_journal() {
  const char* const named = std::getenv("JOURNAL_STREAM");
  struct stat found {};
  return named != nullptr && ::fstat(STDERR_FILENO, &found) == 0 &&
         fmt::format("{}:{}", found.st_dev, found.st_ino) == named;
}

ServiceManager::ServiceManager() : there_{std::getenv("NOTIFY_SOCKET") != nullptr} {
  std::uint64_t interval_us = 0;
  if (sd_watchdog_enabled(0, &interval_us) > 0)
    watchdog_interval_ = std::chrono::microseconds{interval_us};
}

// A processor that is slow, or emulated, draws its first picture after minutes; one that hangs in a
// step is still found out.
void ServiceManager::starting(std::string_view step) const {
  constexpr std::chrono::microseconds limit = 120s;
  sd_notify(
      0, fmt::format("EXTEND_TIMEOUT_USEC={}\nSTATUS=Starting: {}", limit.count(), step).c_str());
}

// That systemd did not hear is systemd's to notice: it waits for READY=1 and for the watchdog.
void ServiceManager::ready() const {
  sd_notify(0, "READY=1");
}

void ServiceManager::set_watchdog(hal::Duration interval) const {
  if (!watchdog_interval_)
    return;
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(interval);
  sd_notify(0, fmt::format("WATCHDOG_USEC={}", us.count()).c_str());
}

void ServiceManager::kick() const {
  sd_notify(0, "WATCHDOG=1");
}

void ServiceManager::stopping() const {
  sd_notify(0, "STOPPING=1\nSTATUS=Stopping");
}

void ServiceManager::status(const std::string& line) const {
  sd_notify(0, ("STATUS=" + line).c_str());
}

} // namespace octascope::firmware_host
