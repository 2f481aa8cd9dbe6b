#include "firmware-host/commands/recordings/recording_summary.h"

#include <algorithm>
#include <cmath>

namespace octascope::firmware_host {

namespace {

// More than the recorder's thread may be late, and a clock that is kept by the network be corrected.
constexpr double least_pause_s = 1;

// Apart as doubles: a damaged entry may hold any number.
double step_s(std::int64_t from_ns, std::int64_t to_ns) {
  return (static_cast<double>(to_ns) - static_cast<double>(from_ns)) * 1e-9;
}

// An index that does not grow is a damaged entry, and no gap. Older recordings do not count what was
// never triggered: their times tell. A tick is late by less than a period.
std::uint64_t lost_between(const pipeline::RecordedVolume& before,
                           const pipeline::RecordedVolume& after, double volume_period_s) {
  constexpr double most = 1e15;
  const std::uint64_t step = after.index > before.index ? after.index - before.index : 1;
  const double periods =
      std::min(step_s(before.first_line_ns, after.first_line_ns) / volume_period_s, most);
  return (periods > static_cast<double>(step) + 1.5
              ? static_cast<std::uint64_t>(std::llround(periods))
              : step) -
         1;
}

} // namespace

RecordingSummary summarise(std::span<const pipeline::RecordedVolume> volumes,
                           double volume_period_s) {
  RecordingSummary summary;
  summary.volumes = volumes.size();
  if (volumes.empty())
    return summary;
  summary.first_index = volumes.front().index;
  summary.last_index = volumes.back().index;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    summary.lost_b_scans += volumes[i].lost_b_scans;
    summary.lost_lines += volumes[i].lost_lines;
    summary.saturated_lines += volumes[i].saturated_lines;
    if (i == 0)
      continue;
    const double pause_s = step_s(volumes[i - 1].wall_clock_ns, volumes[i].wall_clock_ns) -
                           step_s(volumes[i - 1].published_ns, volumes[i].published_ns);
    if (pause_s > least_pause_s) {
      ++summary.pauses;
      summary.paused_s += pause_s;
    }
    const std::uint64_t gap = lost_between(volumes[i - 1], volumes[i], volume_period_s);
    summary.gaps += gap > 0 ? 1 : 0;
    summary.volumes_in_gaps += gap;
    summary.longest_gap = std::max(summary.longest_gap, gap);
  }
  const double between_s = step_s(volumes.front().first_line_ns, volumes.back().first_line_ns);
  summary.duration_s = between_s + volume_period_s;
  if (between_s > 0)
    summary.rate_hz = static_cast<double>(volumes.size() - 1) / between_s;
  return summary;
}

} // namespace octascope::firmware_host
