#include "firmware-host/configuration.h"

#include <cmath>

#include "pipeline/config_document.h"

namespace octascope::firmware_host {

namespace {

using pipeline::ConfigTable;
using pipeline::NumberRange;

constexpr NumberRange level_range_db{-40, 88};

void read_scan(ConfigTable root, Configuration& configuration) {
  const bool present = root.has("scan");
  ConfigTable scan = root.table("scan");
  pipeline::ScanPlan plan;
  const NumberRange counts{1, 65536};
  const NumberRange spacings_um{1e-3, 1e6};
  plan.samples = scan.integer("samples", plan.samples, {16, 65536});
  plan.a_scans = scan.integer("a_scans", plan.a_scans, counts);
  plan.fly_back_lines = scan.integer("fly_back_lines", plan.fly_back_lines, {0, 65536});
  plan.b_scans = scan.integer("b_scans", plan.b_scans, counts);
  plan.line_rate_hz = scan.number("line_rate_hz", plan.line_rate_hz, {1, 1e9});
  plan.depth_spacing_um = scan.number("depth_spacing_um", plan.depth_spacing_um, spacings_um);
  plan.a_spacing_um = scan.number("a_spacing_um", plan.a_spacing_um, spacings_um);
  plan.b_spacing_um = scan.number("b_spacing_um", plan.b_spacing_um, spacings_um);
  plan.bidirectional = scan.boolean("bidirectional", plan.bidirectional);
  plan.turn_around_lines = scan.integer("turn_around_lines", plan.turn_around_lines, {0, 65536});
  plan.phase_offset_a_scans =
      scan.number("phase_offset_a_scans", plan.phase_offset_a_scans,
                  {-static_cast<double>(plan.a_scans), static_cast<double>(plan.a_scans)});
  plan.find_phase_offset = scan.boolean("find_phase_offset", plan.find_phase_offset);
  plan.repeats = scan.integer("repeats", plan.repeats, {1, pipeline::ScanPlan::most_repeats});
  if (present)
    configuration.plan = plan;
}

void read_worker_cores(ConfigTable table, Configuration& configuration) {
  constexpr double highest_core = 1023; // of the sets that the system takes
  for (const double core : table.numbers("worker_cores")) {
    if (core < 0 || core > highest_core || core != std::floor(core)) {
      table.complain("worker_cores must be core numbers from 0 to 1023, as in [2, 3]");
      return;
    }
    configuration.worker_cores.push_back(static_cast<int>(core));
  }
}

void read_pipeline(ConfigTable table, Configuration& configuration) {
  configuration.workers = static_cast<std::size_t>(table.integer("workers", 0, {0, 256}));
  read_worker_cores(table, configuration);
  const auto weights = table.numbers("neighbour_weights");
  if (weights.empty())
    return;
  if (weights.size() != 3 || weights[1] <= 0 || weights[0] < 0 || weights[2] < 0) {
    table.complain("neighbour_weights must be three numbers, before, own (> 0) and after, as in "
                   "[0.25, 0.5, 0.25]");
    return;
  }
  configuration.neighbour_weights = {weights[0], weights[1], weights[2]};
}

void read_display(ConfigTable table, Configuration& configuration) {
  configuration.width = table.integer("width", configuration.width, {320, 16384});
  configuration.height = table.integer("height", configuration.height, {180, 16384});
  configuration.fullscreen = table.boolean("fullscreen", configuration.fullscreen);
  if (table.has("window_offset_db") != table.has("window_size_db"))
    table.complain("window_offset_db and window_size_db go together: give both or neither");
  const double offset_db = table.number("window_offset_db", 0, level_range_db);
  const double size_db = table.number("window_size_db", 1, {1, 128});
  if (table.has("window_offset_db"))
    configuration.window = {static_cast<float>(offset_db), static_cast<float>(size_db)};
  configuration.veil_after = hal::from_seconds(
      table.number("veil_after_s", hal::to_seconds(configuration.veil_after), {0.5, 3600}));
}

void read_controls(ConfigTable table, Configuration& configuration) {
  if (table.has("profile") && table.has("file"))
    table.complain("profile and file are both there, expected one: the name of a profile that the "
                   "program brings with it, or the file of your own");
  configuration.control_profile = table.text("profile", configuration.control_profile);
  configuration.control_file = table.path("file");
  if (const auto known = ui::built_in_profile(configuration.control_profile); !known)
    table.complain(known.error().message);
}

void read_sim(ConfigTable table, Configuration& configuration) {
  configuration.phantom = table.text("phantom", configuration.phantom);
  configuration.loop_volumes = table.integer("loop_volumes", configuration.loop_volumes, {1, 64});
  configuration.galvo_lag_us = table.number("galvo_lag_us", configuration.galvo_lag_us, {0, 1e6});
  configuration.faults = table.path("faults");
  configuration.controls = table.path("controls");
}

} // namespace

hal::Result<Configuration> load_configuration(const std::filesystem::path& file) {
  const auto document = pipeline::ConfigDocument::load(file);
  if (!document)
    return tl::make_unexpected(document.error());
  Configuration configuration;
  ConfigTable root = document->root();
  read_scan(root, configuration);
  configuration.calibration = root.table("calibration").path("file");
  read_pipeline(root.table("pipeline"), configuration);
  ConfigTable display = root.table("display");
  read_display(display, configuration);
  configuration.look = read_look(root, display);
  read_controls(root.table("controls"), configuration);
  read_sim(root.table("sim"), configuration);
  if (const auto finished = document->finish(); !finished)
    return tl::make_unexpected(finished.error());
  return configuration;
}

hal::Result<ui::ControlProfile> load_controls(const Configuration& configuration) {
  return configuration.control_file ? ui::ControlProfile::load(*configuration.control_file)
                                    : ui::built_in_profile(configuration.control_profile);
}

} // namespace octascope::firmware_host
