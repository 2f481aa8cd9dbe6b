#include "firmware-host/run/status_writer.h"

#include <algorithm>

#include "firmware-host/outputs/local_time.h"
#include "hal/plain_text.h"

namespace octascope::firmware_host {

namespace {

constexpr std::size_t longest_subject = 24; // bytes: what finds room beside what else is said

// The successor of the shown volume is due: those that were passed over came, and were not to be shown. After
// a picture that took long there may be many, and it is old all the same.
hal::Duration later_by(std::uint64_t passed_over, hal::Duration volume_period) {
  constexpr hal::Duration enough = std::chrono::milliseconds{300};
  const hal::Duration most = std::max(volume_period, enough);
  return most / volume_period < static_cast<std::int64_t>(passed_over)
             ? most
             : static_cast<std::int64_t>(passed_over) * volume_period;
}

} // namespace

void StatusWriter::tell(const HostStatus& host) {
  status_.devices = host.devices;
  status_.device_count = host.device_count;
  status_.simulated = host.simulated;
  status_.source_description = host.source;
  if (host.replayed && !status_.replay) // before the first volume has come, too
    status_.replay.emplace();
  status_.eye = host.whose.eye;
  status_.subject = hal::shortened(host.whose.subject, longest_subject);
  status_.time_of_day = host.time_of_day;
  status_.configuration = host.configuration;
  status_.another_camera = host.another_camera;
  status_.recording = host.recording;
  status_.notice = host.notice;
}

// The volume itself says that it was recorded, and when: nobody can forget to.
void StatusWriter::show(const pipeline::Volume& volume) {
  const pipeline::VolumeMetadata& metadata = volume.metadata;
  shown_ =
      ui::ShownVolume{metadata.last_line, metadata.published, metadata.recorded_ns.has_value()};
  if (!metadata.recorded_ns)
    status_.replay.reset();
  else if (!status_.replay)
    status_.replay.emplace();
  if (status_.replay)
    status_.replay->recorded = local_date_and_time(*metadata.recorded_ns);
  passed_over_before_ = passed_over_;
  status_.missing_b_scans = volume.missing_b_scans();
  status_.saturated_lines = metadata.saturated_lines;
}

void StatusWriter::count(const RunCounters& counters, hal::TimePoint now) {
  status_.now = now;
  passed_over_ = counters.volumes.passed_over;
  volume_rate_.update(counters.volumes.acquired + counters.volumes.passed_over, now);
  shown_rate_.update(counters.displayed, now);
  line_rate_.update(counters.lines, now);
  frame_rate_.update(counters.frames_drawn, now);
  status_.volumes_per_s = volume_rate_.per_second();
  status_.shown_volumes_per_s = shown_rate_.per_second();
  status_.lines_per_s = line_rate_.per_second();
  status_.frames_per_s = frame_rate_.per_second();
  status_.losses = {counters.volumes.lost_lines, counters.volumes.lost_b_scans,
                    counters.volumes.lost_volumes};
  if (counters.latency.count > 0) {
    status_.latency_p50_ms = counters.latency.p50_ms;
    status_.latency_p95_ms = counters.latency.p95_ms;
  }
}

void StatusWriter::roll(bool asked, bool possible,
                        const std::optional<pipeline::RollingVolume::Seam>& seam) {
  status_.rolling.reset();
  if (!asked)
    return;
  status_.rolling.emplace().possible = possible;
  if (seam)
    status_.rolling->seam = {status_.now - seam->newer, status_.now - seam->older};
}

void StatusWriter::judge(const ui::FreshnessLimits& limits,
                         const std::optional<hal::TimePoint>& frozen_since) {
  std::optional<ui::ShownVolume> shown = shown_;
  if (shown)
    shown->arrived += later_by(passed_over_ - passed_over_before_, limits.volume_period);
  status_.freshness = ui::judge_freshness(shown, status_.now, limits, frozen_since);
}

} // namespace octascope::firmware_host
