#include "firmware-host/report/replay_report.h"

#include <fmt/format.h>

#include "firmware-host/report/report_parts.h"
#include "firmware-host/version/version.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

ReportJson recording_to_json(const ReplayReport& r) {
  return {{"file", r.file.string()},
          {"begun", r.facts.begun},
          {"recorded_by", r.facts.recorded_by},
          {"source", r.facts.source},
          {"simulated", r.facts.simulated},
          {"subject", r.facts.subject},
          {"eye", to_string(r.facts.eye)},
          {"finished", r.end.finished},
          {"volumes", r.recorded}};
}

} // namespace

std::string to_json(const ReplayReport& r) {
  const pipeline::VolumeCounters& volumes = r.counters.volumes;
  const ReportJson json = {
      {"version", version()},
      {"replayed", recording_to_json(r)},
      {"simulated", r.facts.simulated},
      {"duration_s", rounded(r.duration_s)},
      {"devices", {{"control_input", r.control_input}, {"display", r.display}}},
      {"volumes",
       {{"planned", volumes.planned},
        {"acquired", volumes.acquired},
        {"published", volumes.published},
        {"displayed", r.counters.displayed},
        {"skipped", volumes.skipped}}},
      {"lost", lost_to_json(r.counters)},
      {"saturated_lines", volumes.saturated_lines},
      {"latency_ms", to_json(r.counters.latency)},
      {"frames", {{"drawn", r.counters.frames_drawn}}},
      {"quality", to_json(r.quality)},
      {"hot_path", {{"allocations", r.counters.hot_path_allocations}}},
      {"faults", to_json(r.faults, r.started)}};
  // What a file says of itself may be in anything.
  return json.dump(2, ' ', false, ReportJson::error_handler_t::replace) + "\n";
}

std::string to_text(const ReplayReport& r) {
  const RunCounters& c = r.counters;
  std::string text = fmt::format(
      "replayed {} of {} volumes, begun {}: {:.1f} s, {} volumes displayed of {} published, {} "
      "frames\n"
      "lost: {} lines, {} B-scans, {} volumes\n",
      r.file.string(), r.recorded, r.facts.begun, r.duration_s, c.displayed, c.volumes.published,
      c.frames_drawn, c.volumes.lost_lines, c.volumes.lost_b_scans, c.volumes.lost_volumes);
  if (!r.end.finished)
    text += "the recording was never finished: what is in it is whole\n";
  return text + to_text(r.faults);
}

hal::Result<> write_report(const ReplayReport& report, const std::filesystem::path& file) {
  return pipeline::write_atomically(file, to_json(report));
}

} // namespace octascope::firmware_host
