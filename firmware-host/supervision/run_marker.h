// Remembers, from one run to the next, whether the last one ended in good order.
#pragma once

#include <filesystem>

namespace octascope::firmware_host {

// A file "running" in the folder for as long as the object lives; it names the boot. What is left
// of an earlier run says how that one ended.
class RunMarker {
public:
  enum class LastRun {
    orderly,   // or there was none
    crashed,   // crashed or killed, since the machine was started
    power_lost // with the machine: it was switched off, or it hung
  };

  // `boot_id` names this boot of the machine. What cannot be read or written is as if not there.
  RunMarker(const std::filesystem::path& folder,
            const std::filesystem::path& boot_id = "/proc/sys/kernel/random/boot_id");
  ~RunMarker(); // this run ended in good order
  RunMarker(const RunMarker&) = delete;
  RunMarker& operator=(const RunMarker&) = delete;

  LastRun last_run() const { return last_run_; }

private:
  std::filesystem::path file_;
  LastRun last_run_ = LastRun::orderly;
};

} // namespace octascope::firmware_host
