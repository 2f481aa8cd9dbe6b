#include "firmware-host/commands/recordings/recording_summary.h"

#include <algorithm>

namespace octascope::firmware_host {

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
    // An index that does not grow would be a damaged entry, and no gap.
    if (i == 0 || volumes[i].index <= volumes[i - 1].index + 1)
      continue;
    const std::uint64_t gap = volumes[i].index - volumes[i - 1].index - 1;
    ++summary.gaps;
    summary.volumes_in_gaps += gap;
    summary.longest_gap = std::max(summary.longest_gap, gap);
  }
  const double between_s = (static_cast<double>(volumes.back().first_line_ns) -
                            static_cast<double>(volumes.front().first_line_ns)) *
                           1e-9;
  summary.duration_s = between_s + volume_period_s;
  if (between_s > 0)
    summary.rate_hz = static_cast<double>(volumes.size() - 1) / between_s;
  return summary;
}

} // namespace octascope::firmware_host
