#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/bench/flow/bench_flow.h"

namespace octascope::firmware_host {

namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t depth_axis = 2;

const char* name_of(pipeline::FlowMethod method) {
  return method == pipeline::FlowMethod::complex_bins ? "complex" : "intensity";
}

std::string radius_name(std::size_t bin) {
  return fmt::format("{}-{}", radius_edges_um[bin], radius_edges_um[bin + 1]);
}

// At most, from one repeat to the next.
double motion_between_repeats_um(const pipeline::ScanPlan& plan) {
  double sum = 0;
  for (const sim::MotionTone& tone : bench_motion().axial)
    sum += 2 * tone.amplitude_um *
           std::abs(std::sin(std::numbers::pi * tone.frequency_hz *
                             hal::to_seconds(plan.frame_period())));
  return sum;
}

double rounded_figure(double value) {
  return std::round(value * 1e4) / 1e4;
}

Json json_of(const TreeFigures& tree) {
  Json json{{"quality", rounded_figure(tree.quality)}};
  if (!tree.refusal.empty()) {
    json["refusal"] = tree.refusal;
    return json;
  }
  json["true_length_mm"] = rounded_figure(tree.comparison.true_length_mm);
  json["found_share"] = rounded_figure(tree.comparison.found_share);
  json["invented_share"] = rounded_figure(tree.comparison.invented_share);
  return json;
}

Json centreline_error(const TreeFigures& tree) {
  if (!tree.refusal.empty())
    return nullptr;
  const auto& [a_scans, b_scans, depth] = tree.comparison.axes;
  const pipeline::AxisErrors& distance = tree.comparison.distance;
  return {{"p50", rounded_figure(distance.p50_um)},
          {"p95", rounded_figure(distance.p95_um)},
          {"p95_along_depth", rounded_figure(depth.p95_um)},
          {"p95_along_a_scans", rounded_figure(a_scans.p95_um)},
          {"p95_along_b_scans", rounded_figure(b_scans.p95_um)}};
}

// Null of the method that no run uses.
void add_live(Json& json, const std::optional<LiveFlowFigures>& live) {
  const auto figure = [&](double LiveFlowFigures::*value) {
    return live ? Json(rounded_figure((*live).*value)) : Json();
  };
  json["angiograms_per_s"] = figure(&LiveFlowFigures::angiograms_per_s);
  json["lost_lines"] = figure(&LiveFlowFigures::lost_lines);
  json["live"] = nullptr;
  if (live)
    json["live"] = {{"line_rate_hz", live->line_rate_hz},
                    {"planned_per_s", figure(&LiveFlowFigures::planned_per_s)},
                    {"compared_share", figure(&LiveFlowFigures::compared_share)},
                    {"left_out_share", figure(&LiveFlowFigures::left_out_share)},
                    {"b_scan_ms",
                     {{"p50", figure(&LiveFlowFigures::b_scan_ms_p50)},
                      {"p95", figure(&LiveFlowFigures::b_scan_ms_p95)}}}};
}

Json json_of(const FlowBenchCase& what) {
  Json by_radius = Json::object();
  for (std::size_t bin = 0; bin < radius_bins; ++bin)
    by_radius[radius_name(bin)] = what.flow.flowing_by_radius[bin] > 0
                                      ? Json(rounded_figure(what.flow.detected_by_radius[bin]))
                                      : Json();
  Json json{{"repeats", what.repeats},
            {"method", name_of(what.method)},
            {"voxels", what.flow.voxels},
            {"told_share", rounded_figure(what.flow.told_share)},
            {"auc", rounded_figure(what.flow.auc)},
            {"false_positive_share", rounded_figure(what.flow.false_positive_share)},
            {"detected_share", rounded_figure(what.flow.detected_share)},
            {"detected_share_by_radius_um", std::move(by_radius)},
            {"left_out_b_scans", what.left_out_b_scans},
            {"centreline_error_um", centreline_error(what.tree)},
            {"tree", json_of(what.tree)}};
  add_live(json, what.live);
  return json;
}

std::string tree_text(const TreeFigures& tree) {
  if (!tree.refusal.empty())
    return "refused: " + tree.refusal;
  const pipeline::TreeComparison& c = tree.comparison;
  return fmt::format("{:>6.1f} % {:>6.1f} %  {:>5.1f} {:>5.1f}  {:>5.1f} {:>5.1f} {:>5.1f}",
                     100 * c.found_share, 100 * c.invented_share, c.distance.p50_um,
                     c.distance.p95_um, c.axes[depth_axis].p95_um, c.axes[0].p95_um,
                     c.axes[1].p95_um);
}

} // namespace

std::string to_text(const FlowBenchReport& report) {
  const pipeline::ScanPlan& plan = report.plan;
  std::string text = fmt::format(
      "perfused tissue, {} depths x {} A-scans x {} B-scans, {:.0f} kHz; it moves by 10 µm, up to\n"
      "{:.1f} µm between repeats. Voxels of tissue more than 3 dB above the noise, of them told;\n"
      "area under the curve; static tissue called flowing; flowing voxels found, by the vessel's\n"
      "radius in µm.\n\n"
      "repeats  method        told    AUC  false +   found",
      plan.geometry().depths, plan.a_scans, plan.b_scans, plan.line_rate_hz * 1e-3,
      motion_between_repeats_um(plan));
  const auto end = std::back_inserter(text);
  for (std::size_t bin = 0; bin < radius_bins; ++bin)
    fmt::format_to(end, " {:>7}", radius_name(bin));
  text += '\n';
  for (const FlowBenchCase& what : report.cases) {
    const FlowFigures& f = what.flow;
    fmt::format_to(end, "{:>7}  {:<9} {:>6.1f} % {:>6.3f} {:>6.2f} % {:>5.1f} %", what.repeats,
                   name_of(what.method), 100 * f.told_share, f.auc, 100 * f.false_positive_share,
                   100 * f.detected_share);
    for (std::size_t bin = 0; bin < radius_bins; ++bin)
      text += f.flowing_by_radius[bin] > 0
                  ? fmt::format(" {:>5.1f} %", 100 * f.detected_by_radius[bin])
                  : fmt::format(" {:>7}", "-");
    text += '\n';
  }
  fmt::format_to(
      end,
      "\nVessels traced in it, {:.0f} µm or more in radius: length found, length invented; "
      "µm from the\ntrue centreline, median and p95; p95 along depth, A-scans and "
      "B-scans.\n\n"
      "repeats  method       found invented   p50   p95  depth     A     B\n",
      traced_radius_um);
  for (const FlowBenchCase& what : report.cases) {
    fmt::format_to(end, "{:>7}  {:<9} {}\n", what.repeats, name_of(what.method),
                   tree_text(what.tree));
    if (what.left_out_b_scans > 0)
      fmt::format_to(end, "         {} B-scans left out: moved too far\n", what.left_out_b_scans);
  }
  text +=
      "\nLive, with a display: volumes with flow in all B-scans, and planned; B-scans that there "
      "was\n"
      "time to compare, and of them left out; a worker's time for one, median and p95.\n\n"
      "repeats   line rate  angiograms/s  planned   lost lines  compared  left out     ms    p95\n";
  for (const FlowBenchCase& what : report.cases)
    if (what.live)
      fmt::format_to(end,
                     "{:>7} {:>7.0f} kHz {:>13.2f} {:>8.2f} {:>12.0f} {:>7.1f} % {:>7.1f} % "
                     "{:>6.2f} {:>6.2f}\n",
                     what.repeats, what.live->line_rate_hz * 1e-3, what.live->angiograms_per_s,
                     what.live->planned_per_s, what.live->lost_lines,
                     100 * what.live->compared_share, 100 * what.live->left_out_share,
                     what.live->b_scan_ms_p50, what.live->b_scan_ms_p95);
  return text;
}

std::string to_json(const FlowBenchReport& report) {
  const pipeline::ScanPlan& plan = report.plan;
  Json json{{"phantom", "perfused"},
            {"depths", plan.geometry().depths},
            {"a_scans", plan.a_scans},
            {"b_scans", plan.b_scans},
            {"line_rate_hz", plan.line_rate_hz},
            {"axial_motion", Json::array()},
            {"motion_between_repeats_um", rounded_figure(motion_between_repeats_um(plan))},
            {"traced_radius_um", traced_radius_um},
            {"cases", Json::array()}};
  for (const sim::MotionTone& tone : bench_motion().axial)
    json["axial_motion"].push_back(Json::array({tone.amplitude_um, tone.frequency_hz}));
  for (const FlowBenchCase& what : report.cases)
    json["cases"].push_back(json_of(what));
  return json.dump(2);
}

} // namespace octascope::firmware_host
