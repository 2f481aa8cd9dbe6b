#include "firmware-host/report/report.h"

#include <cmath>

#include <fmt/format.h>

#include "firmware-host/report/report_parts.h"
#include "firmware-host/version/version.h"
#include "pipeline/files/atomic_file.h"
#include "ui/view/action_table.h"

namespace octascope::firmware_host {

namespace {

using Json = ReportJson;

// The times are null where there was no choice to make.
Json reconstruction_to_json(const RunReport& report) {
  Json json = {{"path", report.reconstruction_path},
               {"isa", report.reconstruction_isa},
               {"reason", report.reconstruction_reason},
               {"fused_ns_per_line", nullptr},
               {"fftw_ns_per_line", nullptr}};
  if (report.reconstruction_times) {
    json["fused_ns_per_line"] = std::round(report.reconstruction_times->fused_ns);
    json["fftw_ns_per_line"] = std::round(report.reconstruction_times->fftw_ns);
  }
  return json;
}

// Null where there was no choice to make.
Json rays_to_json(const RunReport& report) {
  if (!report.rays)
    return {};
  return {{"cast_by", report.rays->faster() == ui::RayBackend::processor ? "processor" : "shader"},
          {"processor_ms", rounded(hal::to_ms(report.rays->processor))},
          {"shader_ms", rounded(hal::to_ms(report.rays->shader))}};
}

// Null where nobody asked.
Json flow_to_json(const RunReport& report) {
  if (!report.flow)
    return {};
  const FlowSummary& flow = *report.flow;
  return {{"angiograms", flow.angiograms},
          {"angiograms_per_s", rounded(static_cast<double>(flow.angiograms) / report.duration_s)},
          {"b_scans",
           {{"told", flow.told},
            {"left_out", flow.left_out},
            {"none", flow.none},
            {"no_time", flow.no_time}}},
          {"ms", to_json(flow.tell)}};
}

// Null where the volumes come without flow.
Json trees_to_json(const RunReport& report) {
  if (!report.trees)
    return {};
  const auto& [traced, refused, took] = *report.trees;
  return {{"traced", traced},
          {"refused", refused},
          {"seconds",
           {{"p50", rounded(took.p50_ms * 1e-3)},
            {"p95", rounded(took.p95_ms * 1e-3)},
            {"max", rounded(took.max_ms * 1e-3)}}}};
}

Json stages_to_json(const RunReport& report) {
  Json json = {{"histogram_ms", StageSummary::most_ms}};
  for (std::size_t i = 0; i < stage_count; ++i) {
    const StageSummary& stage = report.stages[i];
    Json& place = json[std::string{name_of(static_cast<Stage>(i))}];
    place = {{"ms", to_json(stage.lengths)}, {"histogram", stage.histogram}};
  }
  return json;
}

Json scan_to_json(const RunReport& report) {
  const pipeline::ScanPlan& plan = report.plan;
  Json scan = {{"bidirectional", plan.bidirectional},
               {"repeats", plan.repeats},
               {"lines_per_sweep", plan.lines_per_frame()},
               {"kept_lines_per_sweep", plan.a_scans},
               {"sweeps_per_volume", plan.sweeps()},
               {"planned_volumes_per_s", rounded(plan.volumes_per_s())}};
  if (plan.bidirectional) {
    const pipeline::ScanLagStatus& scan_lag = report.scan_lag;
    scan["phase_offset"] = {{"a_scans", rounded(scan_lag.in_use_a_scans)},
                            {"automatic", scan_lag.automatic},
                            {"estimates_used", scan_lag.used},
                            {"estimates_refused", scan_lag.refused},
                            {"correlation", rounded(scan_lag.correlation)},
                            {"significance", rounded(scan_lag.significance)}};
  }
  return scan;
}

// The shifts and turns of the vessels are one key of three numbers each.
Json view_to_json(const ui::ViewState& view) {
  Json json;
  for (const ui::ActionRow& row : ui::action_table()) {
    if (row.key.empty())
      continue;
    Json& place = json[std::string{row.key}];
    std::visit(ui::Overloaded{
                   [](const ui::NoValue&) {},
                   [&](const ui::Number& v) {
                     if (v.nudge != nullptr)
                       place.push_back(v.of(view));
                     else if (v.index != nullptr)
                       place = view.*v.index;
                     else
                       place = rounded(v.of(view));
                   },
                   [&](const ui::Flag& v) { place = view.*v.flag; },
                   [&](const ui::Choice& v) { place = v.values[v.of(view)].name; },
                   [&](const ui::NamedChoice& v) { place = view.*v.index; },
               },
               row.value);
  }
  json["selected"] = to_string(view.selected);
  return json;
}

Json picture_to_json(const ShownPicture& picture) {
  return {{"liveness", to_string(picture.freshness.liveness)},
          {"age_ms", rounded(hal::to_ms(picture.freshness.age))},
          {"notice", picture.notice},
          {"missing_b_scans", picture.missing_b_scans},
          {"saturated_lines", picture.saturated_lines},
          {"another_camera", picture.another_camera}};
}

Json actions_to_json(const RunReport& report) {
  Json actions;
  for (const ui::ActionRow& row : ui::action_table())
    actions[std::string{row.name}] = report.actions[ui::index_of(row.action)];
  return actions;
}

} // namespace

std::string to_json(const RunReport& r) {
  const pipeline::VolumeCounters& volumes = r.counters.volumes;
  const Json json = {
      {"version", version()},
      {"simulated", r.simulated},
      {"source", r.source},
      {"duration_s", rounded(r.duration_s)},
      {"devices",
       {{"line_camera", r.line_camera},
        {"galvo_trigger", r.galvo_trigger},
        {"control_input", r.control_input},
        {"scope_camera", r.scope_camera},
        {"display", r.display}}},
      {"calibration",
       {{"camera", r.calibration.camera},
        {"line_camera", r.calibration.line_camera},
        {"verdict", r.calibration.verdict}}},
      {"reconstruction", reconstruction_to_json(r)},
      {"scan", scan_to_json(r)},
      {"workers", {{"count", r.worker_cores.size()}, {"cores", r.worker_cores}}},
      {"volumes",
       {{"planned", volumes.planned},
        {"acquired", volumes.acquired},
        {"published", volumes.published},
        {"displayed", r.counters.displayed},
        {"skipped", volumes.skipped},
        {"passed_over", volumes.passed_over},
        {"lost", r.counters.undisplayed},
        {"unfinished", volumes.unfinished}}},
      {"lost", lost_to_json(r.counters)},
      {"saturated_lines", volumes.saturated_lines},
      {"flow", flow_to_json(r)},
      {"rates", to_json(r.counters.rates)},
      {"stage_ms",
       {{"reconstruct", to_json(r.reconstruct)},
        {"assemble", to_json(r.assemble)},
        {"publish", to_json(r.publish)},
        {"upload", to_json(r.upload)},
        {"draw", to_json(r.draw)}}},
      {"latency_ms", to_json(r.counters.latency)},
      {"line_latency_ms", to_json(r.line_latency)},
      {"latency_stages", stages_to_json(r)},
      {"control_ms", to_json(r.control)},
      {"rays", rays_to_json(r)},
      {"vessel_trees", trees_to_json(r)},
      {"first_picture_s", r.first_picture_s ? Json(rounded(*r.first_picture_s)) : Json()},
      {"frames", {{"drawn", r.counters.frames_drawn}, {"missed", r.counters.frames_missed}}},
      {"quality", to_json(r.quality)},
      {"hot_path", {{"allocations", r.counters.hot_path_allocations}}},
      {"picture", picture_to_json(r.picture)},
      {"view", view_to_json(r.view)},
      {"actions", actions_to_json(r)},
      {"faults", to_json(r.faults, r.started)},
  };
  return json.dump(2) + "\n";
}

std::string to_text(const RunReport& r) {
  const RunCounters& c = r.counters;
  std::string text = fmt::format(
      "{:.1f} s, {} volumes displayed of {} that came ({:.2f}/s, {:.0f} lines/s), {} frames "
      "({:.1f}/s)\n"
      "lost: {} lines, {} B-scans, {} volumes; latency {:.0f} ms median, {:.0f} ms p95\n",
      r.duration_s, c.displayed, c.volumes.acquired + c.volumes.passed_over, c.rates.volumes_per_s,
      c.rates.lines_per_s, c.frames_drawn, c.rates.frames_per_s, c.volumes.lost_lines,
      c.volumes.lost_b_scans, c.volumes.lost_volumes, c.latency.p50_ms, c.latency.p95_ms);
  if (c.volumes.passed_over > 0)
    text +=
        fmt::format("{} volumes were not reconstructed: the display would not have come to them\n",
                    c.volumes.passed_over);
  if (const std::string quality = to_text(r.quality); !quality.empty())
    text += fmt::format("the volume was drawn at {}\n", quality);
  if (r.flow)
    text += fmt::format(
        "flow: {} angiograms ({:.2f}/s); of their B-scans {} told, {} left out that "
        "moved too far, {} without (no time for {}); {:.1f} ms each median, "
        "{:.1f} ms p95\n",
        r.flow->angiograms, static_cast<double>(r.flow->angiograms) / r.duration_s, r.flow->told,
        r.flow->left_out, r.flow->none, r.flow->no_time, r.flow->tell.p50_ms, r.flow->tell.p95_ms);
  if (r.plan.bidirectional)
    text +=
        fmt::format("bidirectional: phase offset {:.2f} A-scans, {}\n", r.scan_lag.in_use_a_scans,
                    !r.scan_lag.automatic ? "as configured"
                    : r.scan_lag.used > 0 ? "found in the picture"
                                          : "as configured: the picture shows no better one");
  if (r.trees)
    text += fmt::format("vessel trees: {} traced, {} refused; {:.2f} s median, {:.2f} s p95\n",
                        r.trees->traced, r.trees->refused, r.trees->took.p50_ms * 1e-3,
                        r.trees->took.p95_ms * 1e-3);
  return text + to_text(r.faults);
}

hal::Result<> write_report(const RunReport& report, const std::filesystem::path& file) {
  return pipeline::write_atomically(file, to_json(report));
}

} // namespace octascope::firmware_host
