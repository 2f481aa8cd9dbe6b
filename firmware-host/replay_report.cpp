#include "firmware-host/replay_report.h"

#include <cmath>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/version.h"
#include "pipeline/atomic_file.h"

namespace octascope::firmware_host {

namespace {

using ReplayJson = nlohmann::ordered_json;

double to_thousandths(double value) {
  return std::round(value * 1000.0) / 1000.0;
}

ReplayJson recording_to_json(const ReplayReport& r) {
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

ReplayJson replay_faults_to_json(const ReplayReport& r) {
  ReplayJson faults = ReplayJson::array();
  for (const pipeline::FaultRecord& f : r.faults)
    faults.push_back({{"device", f.device},
                      {"kind", f.kind},
                      {"message", f.message},
                      {"count", f.count},
                      {"first_s", to_thousandths(hal::to_seconds(f.first - r.started))},
                      {"last_s", to_thousandths(hal::to_seconds(f.last - r.started))}});
  return faults;
}

} // namespace

std::string to_json(const ReplayReport& r) {
  const ReplayJson json = {
      {"version", version()},
      {"replayed", recording_to_json(r)},
      {"simulated", r.facts.simulated},
      {"duration_s", to_thousandths(r.duration_s)},
      {"devices", {{"control_input", r.control_input}, {"display", r.display}}},
      {"volumes",
       {{"planned", r.volumes.planned},
        {"acquired", r.volumes.acquired},
        {"published", r.volumes.published},
        {"displayed", r.displayed},
        {"skipped", r.volumes.skipped}}},
      {"lost",
       {{"lines", r.volumes.lost_lines},
        {"b_scans", r.volumes.lost_b_scans},
        {"volumes", r.volumes.lost_volumes}}},
      {"saturated_lines", r.volumes.saturated_lines},
      {"latency_ms",
       {{"p50", to_thousandths(r.latency.p50_ms)},
        {"p95", to_thousandths(r.latency.p95_ms)},
        {"max", to_thousandths(r.latency.max_ms)}}},
      {"frames", {{"drawn", r.frames_drawn}}},
      {"hot_path", {{"allocations", r.hot_path_allocations}}},
      {"faults", replay_faults_to_json(r)}};
  // What a file says of itself may be in anything.
  return json.dump(2, ' ', false, ReplayJson::error_handler_t::replace) + "\n";
}

std::string to_text(const ReplayReport& r) {
  std::string text = fmt::format(
      "replayed {} of {} volumes, begun {}: {:.1f} s, {} volumes displayed of {} published, {} "
      "frames\n"
      "lost: {} lines, {} B-scans, {} volumes\n",
      r.file.string(), r.recorded, r.facts.begun, r.duration_s, r.displayed, r.volumes.published,
      r.frames_drawn, r.volumes.lost_lines, r.volumes.lost_b_scans, r.volumes.lost_volumes);
  if (!r.end.finished)
    text += "the recording was never finished: what is in it is whole\n";
  for (const pipeline::FaultRecord& f : r.faults)
    text += fmt::format("fault: {} {} ×{}: {}\n", f.device, f.kind, f.count, f.message);
  return text;
}

hal::Result<> write_report(const ReplayReport& report, const std::filesystem::path& file) {
  auto out = pipeline::AtomicFile::create(file);
  if (!out)
    return tl::make_unexpected(out.error());
  const std::string json = to_json(report);
  return out->write_at(0, std::as_bytes(std::span{json})).and_then([&] { return out->commit(); });
}

} // namespace octascope::firmware_host
