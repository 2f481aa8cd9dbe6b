// Remembers whether the previous run ended in good order.
#pragma once

#include <filesystem>

namespace octascope::firmware_host {

// A file "running" in the folder exists as long as the object; it names the boot. A file left by an
// earlier run tells how that one ended.
class RunMarker {
public:
  enum class LastRun {
    orderly,   // or there was none
    crashed,   // crashed or killed, during this boot
    power_lost // ended with the machine: switched off or hung
  };

  // `boot_id` names this boot. A file that cannot be read or written is treated as absent.
  RunMarker(const std::filesystem::path& folder,
            const std::filesystem::path& boot_id = "/proc/sys/kernel/random/boot_id");
  ~RunMarker(); // marks this run as ended in good order
  RunMarker(const RunMarker&) = delete;
  RunMarker& operator=(const RunMarker&) = delete;

  LastRun last_run() const { return last_run_; }

private:
  std::filesystem::path file_;
  LastRun last_run_ = LastRun::orderly;
};

} // namespace octascope::firmware_host
