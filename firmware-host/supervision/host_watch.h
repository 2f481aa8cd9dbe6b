// Trouble of the machine itself: a full disk, a jump of the clock, little memory, heat.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"

namespace octascope::firmware_host {

// What a machine reports about itself; empty: not reported.
struct HostFindings {
  std::optional<std::uint64_t> available_bytes; // of memory, without swapping (proc_meminfo(5))
  std::optional<double> memory_stall_percent;   // "full avg10" of the kernel's pressure stalls
  std::optional<std::uint64_t> resident_bytes;  // of this process
  std::optional<double> temperature_c;          // of the hottest thermal zone
  std::optional<std::uint64_t> throttlings;     // of the processor since the boot, by its own count
  bool beyond_trip = false; // a zone is at the temperature where the kernel starts throttling
};

// Reads /proc and /sys below `root`; otherwise pure.
HostFindings find_out_about_host(const std::filesystem::path& root = "/");

struct DiskSpace {
  std::uint64_t free_bytes = 0; // for this user
};

// Each condition is one kind of host fault, counted once a look while it lasts; it is reported,
// nothing else. One thread.
class HostWatch {
public:
  struct Setup {
    std::filesystem::path root = "/";
    std::vector<std::filesystem::path> written{}; // folders that files are written into
    // Replaced in tests.
    std::function<std::optional<DiskSpace>(const std::filesystem::path&)> disk_space{};
    std::function<std::chrono::nanoseconds()> wall_clock{}; // since 1970
  };

  // Reported below these.
  static constexpr std::uint64_t least_disk_bytes = 32ULL << 20U;
  static constexpr std::uint64_t least_memory_bytes = 96ULL << 20U;
  static constexpr double most_stall_percent = 10;
  static constexpr hal::Duration largest_jump = std::chrono::seconds{1};

  // Empty functions in the setup mean the machine's own.
  explicit HostWatch(Setup setup);

  void look(pipeline::FaultLog& faults, hal::TimePoint now);

  // From the last look.
  const HostFindings& findings() const { return findings_; }

private:
  void look_at_disks(pipeline::FaultLog& faults, hal::TimePoint now) const;
  void look_at_clock(pipeline::FaultLog& faults, hal::TimePoint now);
  void look_at_memory(pipeline::FaultLog& faults, hal::TimePoint now) const;
  void look_at_heat(pipeline::FaultLog& faults, hal::TimePoint now,
                    std::optional<std::uint64_t> throttlings_before) const;

  Setup setup_;
  HostFindings findings_;
  std::optional<std::chrono::nanoseconds> clocks_apart_; // wall clock less monotonic
};

} // namespace octascope::firmware_host
