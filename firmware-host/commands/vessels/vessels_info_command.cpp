// octascope vessels info: what is in a file of vessels.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/tree_options.h"
#include "firmware-host/commands/vessels/morphometry_json.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/report/progress_line.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/vessels/files/tree_file.h"
#include "pipeline/vessels/tree_summary.h"
#include "sim/coronary_tree/morphometry_table.h"

namespace octascope::firmware_host {

namespace {

using nlohmann::ordered_json;
using pipeline::SwcCounts;
using pipeline::TreeFile;
using pipeline::TreeSummary;
using pipeline::VesselBranch;
using pipeline::VesselFacts;
using pipeline::VtpCounts;

struct VesselsInfoCommandLine {
  std::string file;
  TreeArguments tree;
  bool json = false;
};

struct FileReport {
  std::string name;
  std::uint64_t bytes = 0;
  TreeFile file;
  TreeSummary summary;
  std::optional<sim::MorphometryTable> morphometry;
};

// What reading met with and how it was dealt with: key, words, count.
struct PolicyCount {
  const char* key;
  const char* words;
  std::uint64_t count;
};

std::vector<PolicyCount> policy_counts(const SwcCounts& counts) {
  return {{"rows", "rows", counts.rows},
          {"comments", "comments", counts.comments},
          {"blanks", "blank rows", counts.blanks},
          {"late_parents", "nodes whose parent comes later, sorted", counts.late_parents},
          {"zero_radii", "nodes of radius 0, given their parent's", counts.zero_radii},
          {"coincident", "nodes at their parent's place, kept and not drawn", counts.coincident}};
}

std::vector<PolicyCount> policy_counts(const VtpCounts& counts) {
  return {{"points", "points", counts.points},
          {"lines", "lines", counts.lines},
          {"merged_points", "points at another's place, made one", counts.merged_points},
          {"unused_points", "points in no line, left out", counts.unused_points},
          {"short_lines", "lines of fewer than two points, left out", counts.short_lines},
          {"other_cells", "cells that are no lines, left out", counts.other_cells},
          {"zero_radii", "nodes of radius 0, given their parent's", counts.zero_radii},
          {"coincident", "nodes at their parent's place, kept and not drawn", counts.coincident}};
}

std::vector<PolicyCount> policy_counts(const VesselFacts& facts) {
  return {{"lone_roots", "roots without a child, in no cluster", facts.lone_roots},
          {"coincident", "nodes at their parent's place, kept and not drawn", facts.zero_lengths}};
}

std::vector<PolicyCount> policy_counts(const TreeFile& file) {
  return std::visit([](const auto& counts) { return policy_counts(counts); }, file.counts);
}

const VesselFacts* facts_of(const TreeFile& file) {
  return std::get_if<VesselFacts>(&file.counts);
}

const char* kind_of(const TreeFile& file) {
  static constexpr const char* kinds[] = {"swc", "vtp", "vessels"}; // as file.counts
  return kinds[file.counts.index()];
}

// Where the orders are from.
const char* source_of_orders(const TreeFile& file) {
  const auto* swc = std::get_if<SwcCounts>(&file.counts);
  const bool from_file = facts_of(file) != nullptr || (swc != nullptr && swc->orders_in_file);
  return from_file ? "file" : "tree";
}

constexpr const char* branch_names[] = {"unknown", "rca", "lad", "lcx"};

ordered_json orders_json(const TreeSummary& summary) {
  auto orders = ordered_json::array();
  for (std::size_t i = 0; i < summary.orders.size(); ++i) {
    const pipeline::OrderSummary& order = summary.orders[i];
    if (order.segments > 0)
      orders.push_back({{"order", i},
                        {"segments", order.segments},
                        {"mean_diameter_um", 1000 * order.mean_diameter_mm},
                        {"length_mm", order.length_mm}});
  }
  return orders;
}

// The tree's, where our own format knows it better than what was unpacked from it.
TreeSummary summary_of(const TreeFile& file) {
  TreeSummary summary = pipeline::summarise(file.tree);
  if (const VesselFacts* facts = facts_of(file)) {
    summary.nodes = facts->nodes;
    summary.roots = facts->roots;
    summary.tips += facts->lone_roots;
    summary.lowest_mm = facts->lower_mm;
    summary.highest_mm = facts->upper_mm;
  }
  return summary;
}

// All three coronary arteries and nothing else: then there is something to compare it with.
std::optional<sim::MorphometryTable> morphometry_of(const TreeFile& file,
                                                    const TreeSummary& summary) {
  const auto segments = [&](VesselBranch branch) {
    return summary.branches[static_cast<std::size_t>(branch)];
  };
  if (segments(VesselBranch::unknown) > 0 || segments(VesselBranch::rca) == 0 ||
      segments(VesselBranch::lad) == 0 || segments(VesselBranch::lcx) == 0)
    return std::nullopt;
  return sim::compare_with_published(file.tree);
}

double bytes_a_segment(const FileReport& report) {
  return static_cast<double>(report.bytes) /
         static_cast<double>(std::max<std::uint64_t>(report.summary.segments, 1));
}

void add_facts(const VesselFacts& facts, const FileReport& report, ordered_json& json) {
  json["provenance"] = facts.provenance;
  json["checksums"] = "good"; // else it would not have been read
  json["position_error_um"] = facts.error.position_um;
  json["relative_radius_error"] = facts.error.relative_radius;
  json["bytes_a_segment"] = bytes_a_segment(report);
}

void add_morphometry(const sim::MorphometryTable& table, ordered_json& json) {
  json["scale_factor"] = table.whole_factor;
  json["growth_per_order"] = table.growth;
  json["murray_ratio_below_50_um"] = table.murray_ratio;
  json["table"] = morphometry_json(table);
}

void print_json(const FileReport& report) {
  const TreeFile& file = report.file;
  const TreeSummary& summary = report.summary;
  ordered_json json{{"file", report.name},
                    {"bytes", report.bytes},
                    {"kind", kind_of(file)},
                    {"unit", file.unit == pipeline::LengthUnit::um ? "um" : "mm"},
                    {"nodes", summary.nodes},
                    {"segments", summary.segments},
                    {"roots", summary.roots},
                    {"branch_points", summary.branch_points},
                    {"tips", summary.tips},
                    {"length_mm", summary.length_mm},
                    {"bounds_mm", {summary.lowest_mm, summary.highest_mm}},
                    {"radii_mm", {summary.smallest_radius_mm, summary.largest_radius_mm}},
                    {"orders_from", source_of_orders(file)},
                    {"orders", orders_json(summary)}};
  for (std::size_t i = 0; i < summary.branches.size(); ++i)
    json["branches"][branch_names[i]] = summary.branches[i];
  for (const PolicyCount& policy : policy_counts(file))
    json[policy.key] = policy.count;
  if (const auto* swc = std::get_if<SwcCounts>(&file.counts)) {
    for (const auto& [type, nodes] : swc->types)
      json["types"][std::to_string(type)] = nodes;
  }
  if (const auto* vtp = std::get_if<VtpCounts>(&file.counts))
    json["radius_array"] = vtp->radius_array;
  if (const VesselFacts* facts = facts_of(file))
    add_facts(*facts, report, json);
  if (report.morphometry)
    add_morphometry(*report.morphometry, json);
  // The name of a radius array and a provenance may be no UTF-8.
  say("{}\n", json.dump(2, ' ', false, ordered_json::error_handler_t::replace));
}

void print_orders(const TreeFile& file, const TreeSummary& summary) {
  say("\norders, from the {}\n  order   segments   mean diameter    length\n",
      source_of_orders(file));
  for (std::size_t i = summary.orders.size(); i-- > 0;) {
    const pipeline::OrderSummary& order = summary.orders[i];
    if (order.segments > 0)
      say("  {:5} {:10} {:12.1f} µm {:9.3g} m\n", i, order.segments, 1000 * order.mean_diameter_mm,
          order.length_mm / 1000);
  }
}

void print_facts(const VesselFacts& facts, const FileReport& report) {
  say("  from: {}\n", facts.provenance);
  say("  checksums good; {} bytes, {:.3f} a segment\n", report.bytes, bytes_a_segment(report));
  say("  rounded: places by {:.3g} µm at most, radii by {:.3g} %\n", facts.error.position_um,
      100 * facts.error.relative_radius);
}

void print_text(const FileReport& report) {
  const TreeFile& file = report.file;
  const TreeSummary& summary = report.summary;
  static constexpr const char* kinds[] = {"SWC", "VTP", "our own format"}; // as file.counts
  say("{}: {}, lengths in {}\n", report.name, kinds[file.counts.index()],
      file.unit == pipeline::LengthUnit::um ? "µm" : "mm");
  if (const VesselFacts* facts = facts_of(file))
    print_facts(*facts, report);
  say("  {} nodes, {} segments, {} roots, {} branch points, {} tips\n", summary.nodes,
      summary.segments, summary.roots, summary.branch_points, summary.tips);
  const auto& low = summary.lowest_mm;
  const auto& high = summary.highest_mm;
  say("  bounds {:g} to {:g}, {:g} to {:g}, {:g} to {:g} mm\n", low[0], high[0], low[1], high[1],
      low[2], high[2]);
  say("  radii {:g} to {:g} µm, {:.4g} m of vessels\n", 1000 * summary.smallest_radius_mm,
      1000 * summary.largest_radius_mm, summary.length_mm / 1000);
  say("  branches");
  for (std::size_t i = summary.branches.size(); i-- > 0;)
    say(" {} {}{}", branch_names[i], summary.branches[i], i == 0 ? "\n" : ",");
  print_orders(file, summary);
  say("\nread\n");
  for (const PolicyCount& policy : policy_counts(file))
    say("  {:10} {}\n", policy.count, policy.words);
  if (report.morphometry)
    say("\n{}", sim::to_text(*report.morphometry));
}

int run(const VesselsInfoCommandLine& line) {
  pipeline::TreeReadOptions options = line.tree.options();
  hal::Result<TreeFile> file;
  {
    ProgressLine progress{fmt::format("reading {}", line.file)};
    options.progress = [&](double done) { progress.update(done); };
    file = pipeline::read_tree(line.file, options);
  }
  if (!file)
    return complain("vessels info", file.error());
  FileReport report{line.file, 0, std::move(*file), {}, {}};
  std::error_code gone; // since it was read: then there is no number of bytes
  const auto bytes = std::filesystem::file_size(line.file, gone);
  report.bytes = gone ? 0 : bytes;
  report.summary = summary_of(report.file);
  report.morphometry = morphometry_of(report.file, report.summary);
  if (line.json)
    print_json(report);
  else
    print_text(report);
  return exit_done;
}

} // namespace

void add_vessels_info_command(CLI::App& vessels, int& exit_status) {
  CLI::App* command =
      vessels.add_subcommand("info", "What is in a file of vessels (SWC, VTP, our own .vessels)");
  auto line = std::make_shared<VesselsInfoCommandLine>();
  command->add_option("file", line->file, "Vessel tree; its kind is told by its content")
      ->required()
      ->type_name("FILE");
  add_tree_options(*command, line->tree);
  command->add_flag("--json", line->json, "One JSON object");
  command->footer("A tree of RCA, LAD and LCX is compared with the published morphometry.\n"
                  "Example: octascope vessels info heart.swc --unit um --json");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

} // namespace octascope::firmware_host
