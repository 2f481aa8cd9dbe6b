// What octascope vessels bench prints.
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/vessels/vessel_text.h"
#include "firmware-host/commands/vessels/vessels_bench.h"

namespace octascope::firmware_host {

namespace {

using nlohmann::ordered_json;

double bytes_per_segment(const VesselsBenchTree& tree) {
  return tree.segments == 0 ? 0
                            : static_cast<double>(tree.bytes) / static_cast<double>(tree.segments);
}

double segments_per_s(const VesselsBenchCase& measured) {
  return measured.ms_p50 > 0
             ? 1000 * static_cast<double>(measured.account.total()) / measured.ms_p50
             : 0;
}

// How many times quicker the hybrid is than quads with nothing left out.
std::optional<double> gain(const VesselsBenchView& view) {
  const VesselsBenchCase* hybrid = view.find(to_string(ui::VesselMethodKind::hybrid));
  const VesselsBenchCase* quads = view.find(brute_force_name);
  if (hybrid == nullptr || quads == nullptr || hybrid->ms_p50 <= 0)
    return std::nullopt;
  return quads->ms_p50 / hybrid->ms_p50;
}

ordered_json json_of(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

ordered_json json_of(const VesselsBenchCase& measured) {
  ordered_json json{{"frame_ms_p50", measured.ms_p50},
                    {"frame_ms_p95", measured.ms_p95},
                    {"segments_per_s", segments_per_s(measured)},
                    {"drawn", measured.account.drawn},
                    {"splatted", measured.account.splatted},
                    {"merged", measured.account.merged},
                    {"culled", measured.account.culled},
                    {"mean_abs_diff_to_quads", measured.difference},
                    {"frames", measured.frames}};
  if (measured.supersampled_difference)
    json["mean_abs_diff_to_supersampled"] = *measured.supersampled_difference;
  if (measured.shares) {
    json["expanded_by_gl"] = measured.shares->of_gl;
    json["expanded_by_processor"] = measured.shares->of_processor;
  }
  return json;
}

ordered_json json_of(const ui::VesselView& view) {
  return {{"target_mm", {view.target_mm.x, view.target_mm.y, view.target_mm.z}},
          {"mm_per_pixel", view.mm_per_pixel},
          {"yaw_deg", view.yaw_deg},
          {"tilt_deg", view.tilt_deg}};
}

ordered_json json_of(const VesselsFlightReport& flight) {
  return {{"places", flight.places},
          {"length_mm", flight.length_mm},
          {"frame_ms_p50", flight.ms_p50},
          {"frame_ms_p95", flight.ms_p95},
          {"mean_abs_diff_to_quads_max", flight.worst_difference},
          {"frame_to_frame_max", flight.worst_step},
          {"quads_frame_to_frame_max", flight.worst_quads_step},
          {"frame_to_frame_beyond_quads_max", flight.worst_beyond}};
}

} // namespace

std::string to_json(const VesselsBenchTree& tree, const VesselsBenchReport& report) {
  ordered_json json{{"segments", tree.segments},
                    {"size", fmt::format("{}x{}", report.width, report.height)},
                    {"views", ordered_json::object()}};
  auto definitions = ordered_json::object();
  auto gains = ordered_json::object();
  for (const VesselsBenchView& view : report.views) {
    const std::string name{to_string(view.what)};
    auto& cases = json["views"][name] = ordered_json::object();
    for (const VesselsBenchCase& measured : view.cases)
      cases[measured.method] = json_of(measured);
    definitions[name] = json_of(view.view);
    gains[name] = json_of(gain(view));
  }
  json["view_definitions"] = std::move(definitions);
  json["hybrid_gain_over_brute_force"] = std::move(gains);
  if (report.flight)
    json["fly_through"] = json_of(*report.flight);
  json["memory"] = {{"bytes", tree.bytes},
                    {"bytes_per_segment", bytes_per_segment(tree)},
                    {"mapped", tree.mapped}};
  json["load_ms"] = json_of(tree.load_ms);
  json["build_ms"] = json_of(tree.build_ms);
  json["upload_ms"] = report.upload_ms;
  json["source"] = tree.source;
  json["cpu"] = report.cpu;
  json["gl_renderer"] = report.gl_renderer;
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace); // a file's name
}

std::string to_text(const VesselsBenchTree& tree, const VesselsBenchReport& report) {
  std::string text;
  const auto add = [&]<class... Values>(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
  };
  add("{}\n{}\n{}: {} segments, {} MB{}, {:.2f} bytes a segment\n", report.cpu, report.gl_renderer,
      tree.source, tree.segments, tree.bytes / 1'000'000, tree.mapped ? " mapped" : "",
      bytes_per_segment(tree));
  if (tree.load_ms)
    add("loaded in {:.0f} ms\n", *tree.load_ms);
  if (tree.build_ms)
    add("clusters built in {:.0f} ms\n", *tree.build_ms);
  add("nodes given to GL in {:.0f} ms; pictures of {}x{}\n", report.upload_ms, report.width,
      report.height);
  for (const VesselsBenchView& view : report.views) {
    add("\n{}: {}\n", to_string(view.what), describe(view.view));
    add("method             ms p50   ms p95 frames  M segments/s      drawn   splatted     merged"
        "     culled  difference\n");
    for (const VesselsBenchCase& m : view.cases)
      add("{:<17} {:>7.1f} {:>8.1f} {:>6} {:>13.1f} {:>10} {:>10} {:>10} {:>10} {:>11.3f}{}\n",
          m.method, m.ms_p50, m.ms_p95, m.frames, segments_per_s(m) / 1e6, m.account.drawn,
          m.account.splatted, m.account.merged, m.account.culled, m.difference,
          m.supersampled_difference
              ? fmt::format(" ({:.3f} from supersampled)", *m.supersampled_difference)
              : "");
    if (const VesselsBenchCase* balanced = view.find("balanced"); balanced && balanced->shares)
      add("balanced: {} segments expanded by GL, {} by the processor\n", balanced->shares->of_gl,
          balanced->shares->of_processor);
    if (const auto times = gain(view))
      add("hybrid is {:.1f} times as quick as quads by brute force\n", *times);
  }
  if (const auto& flight = report.flight)
    add("\nflight of {:.0f} mm, {} places: hybrid {:.1f} ms p50, {:.1f} ms p95; {:.3f} from quads; "
        "in "
        "steps of half a pixel {:.3f} from frame to frame, quads {:.3f}, beyond quads {:.3f} (each "
        "the most, of 255)\n",
        flight->length_mm, flight->places, flight->ms_p50, flight->ms_p95, flight->worst_difference,
        flight->worst_step, flight->worst_quads_step, flight->worst_beyond);
  return text;
}

} // namespace octascope::firmware_host
