#include "firmware-host/supervision/host_watch.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/statvfs.h>

#include "hal/linux/system/system_files.h"
#include "hal/number_text.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;

using hal::linux_backend::entries;
using hal::linux_backend::first_line;
using hal::linux_backend::text_after;

namespace {

// The number that the text begins with, after blanks.
template <class Number> std::optional<Number> number_in(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return hal::take_number<Number>(text);
}

template <class Number> std::optional<Number> number_of(const fs::path& file) {
  return number_in<Number>(first_line(file));
}

// "MemAvailable:   12345 kB"
std::optional<std::uint64_t> bytes_of(const fs::path& file, std::string_view key) {
  const auto kib = number_in<std::uint64_t>(text_after(key, file));
  return kib ? std::optional{*kib * 1024} : std::nullopt;
}

// Where the kernel slows things down ("passive") or has the machine switched off ("hot",
// "critical"); "active" only starts a fan.
bool is_beyond_trip(const fs::path& zone, int millidegrees) {
  for (const fs::path& file : entries(zone, "trip_point_")) {
    const std::string name = file.filename().string();
    if (!name.ends_with("_temp"))
      continue;
    const std::string type = first_line(zone / (name.substr(0, name.size() - 4) + "type"));
    const auto trip = number_of<int>(file);
    if (!type.empty() && type != "active" && trip && *trip > 0 && millidegrees >= *trip)
      return true;
  }
  return false;
}

void find_heat(const fs::path& root, HostFindings& findings) {
  for (const fs::path& zone : entries(root / "sys/class/thermal", "thermal_zone")) {
    const auto millidegrees = number_of<int>(zone / "temp");
    if (!millidegrees)
      continue;
    findings.temperature_c =
        std::max(findings.temperature_c.value_or(-273.15), *millidegrees / 1000.0);
    findings.beyond_trip |= is_beyond_trip(zone, *millidegrees);
  }
  for (const fs::path& core : entries(root / "sys/devices/system/cpu", "cpu"))
    if (const auto count = number_of<std::uint64_t>(core / "thermal_throttle/core_throttle_count"))
      findings.throttlings = findings.throttlings.value_or(0) + *count;
}

std::optional<DiskSpace> disk_space_of(const fs::path& folder) {
  struct statvfs space {};
  if (::statvfs(folder.c_str(), &space) != 0)
    return std::nullopt;
  return DiskSpace{static_cast<std::uint64_t>(space.f_bavail) * space.f_frsize};
}

std::chrono::nanoseconds wall_clock_now() {
  return std::chrono::system_clock::now().time_since_epoch();
}

double mebibytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

} // namespace

HostFindings find_out_about_host(const fs::path& root) {
  HostFindings findings;
  findings.available_bytes = bytes_of(root / "proc/meminfo", "MemAvailable:");
  findings.memory_stall_percent =
      number_in<double>(text_after("full avg10=", root / "proc/pressure/memory"));
  findings.resident_bytes = bytes_of(root / "proc/self/status", "VmRSS:");
  find_heat(root, findings);
  return findings;
}

HostWatch::HostWatch(Setup setup) : setup_{std::move(setup)} {
  if (!setup_.disk_space)
    setup_.disk_space = disk_space_of;
  if (!setup_.wall_clock)
    setup_.wall_clock = wall_clock_now;
}

void HostWatch::look(pipeline::FaultLog& faults, hal::TimePoint now) {
  const HostFindings before = std::exchange(findings_, find_out_about_host(setup_.root));
  look_at_disks(faults, now);
  look_at_clock(faults, now);
  look_at_memory(faults, now);
  look_at_heat(faults, now, before.throttlings);
}

void HostWatch::look_at_disks(pipeline::FaultLog& faults, hal::TimePoint now) const {
  for (const fs::path& folder : setup_.written) {
    const auto space = setup_.disk_space(folder);
    if (space && space->free_bytes < least_disk_bytes)
      faults.add(pipeline::Fault::disk_full,
                 fmt::format("{}: {:.0f} MiB are free, expected at least {:.0f}: pictures and "
                             "reports may be lost; delete or move away what is not needed",
                             folder.string(), mebibytes(space->free_bytes),
                             mebibytes(least_disk_bytes)),
                 now);
  }
}

// Nothing in the program goes by the wall clock but names of files and logs: it is told because
// those will be looked for.
void HostWatch::look_at_clock(pipeline::FaultLog& faults, hal::TimePoint now) {
  const std::chrono::nanoseconds apart = setup_.wall_clock() - now.time_since_epoch();
  const auto before = std::exchange(clocks_apart_, apart);
  if (!before)
    return;
  const std::chrono::nanoseconds jump = apart - *before;
  if (std::chrono::abs(jump) > largest_jump)
    faults.add(pipeline::Fault::clock_jump,
               fmt::format("the wall clock was set by {:+.1f} s: names of files and times of logs "
                           "before and after do not fit together",
                           hal::to_seconds(jump)),
               now);
}

void HostWatch::look_at_memory(pipeline::FaultLog& faults, hal::TimePoint now) const {
  const auto& available = findings_.available_bytes;
  const auto& stall = findings_.memory_stall_percent;
  if ((available && *available < least_memory_bytes) || (stall && *stall > most_stall_percent))
    faults.add(pipeline::Fault::low_memory,
               fmt::format("{:.0f} MiB of memory are available, {:.0f} % of the time waits for "
                           "memory, expected at least {:.0f} MiB and at most {:.0f} %: end other "
                           "programs",
                           mebibytes(available.value_or(0)), stall.value_or(0),
                           mebibytes(least_memory_bytes), most_stall_percent),
               now);
}

void HostWatch::look_at_heat(pipeline::FaultLog& faults, hal::TimePoint now,
                             std::optional<std::uint64_t> throttlings_before) const {
  const bool throttled =
      throttlings_before && findings_.throttlings && *findings_.throttlings > *throttlings_before;
  if (throttled || findings_.beyond_trip)
    faults.add(pipeline::Fault::throttled,
               fmt::format("the machine is too hot ({:.0f} °C) and slows itself down: look after "
                           "its fans and its air",
                           findings_.temperature_c.value_or(0)),
               now);
}

} // namespace octascope::firmware_host
