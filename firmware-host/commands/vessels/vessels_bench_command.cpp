// octascope vessels bench FILE, and octascope bench vessels, which may grow its own tree.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/bench/bench_timing.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/tree_options.h"
#include "firmware-host/commands/vessels/vessel_text.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/commands/vessels/vessels_bench.h"
#include "firmware-host/report/progress_line.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/vessels/vessel_source.h"
#include "pipeline/vessels/clusters/cluster_unpacker.h"
#include "sim/coronary_tree/coronary_tree.h"

namespace octascope::firmware_host {

namespace {

struct VesselsBenchCommandLine {
  std::string name; // of the command, for complaints
  std::string file; // empty: a tree is grown
  std::uint32_t segments = 200'000;
  TreeArguments tree;
  bool as_json = false;
  bool no_build = false;
  bool fly_through = false;
  int places = 100;
  std::string size;
  std::vector<std::string> methods;
  std::vector<std::string> views;
  std::string dump;
  VesselsBenchOptions options;
};

hal::Result<VesselsBenchOptions> options_of(const VesselsBenchCommandLine& line) {
  VesselsBenchOptions options = line.options;
  options.methods = line.methods;
  if (!line.views.empty())
    options.views.clear();
  for (const std::string& view : line.views)
    options.views.push_back(views_by_name().at(view));
  options.flight_places = line.fly_through ? line.places : 0;
  if (!line.dump.empty())
    options.dump = line.dump;
  if (!line.size.empty()) {
    HAL_TRY(const auto size, parse_size(line.size));
    options.width = size[0];
    options.height = size[1];
  }
  options.progress = [](std::string_view words) { warn("{}\n", words); };
  return options;
}

struct Loaded {
  LoadedVessels vessels;
  VesselsBenchTree tree;
};

Loaded described(LoadedVessels vessels, std::string source) {
  VesselsBenchTree tree;
  tree.source = std::move(source);
  tree.segments = vessels.clusters().segments;
  tree.bytes = vessels.bytes();
  tree.mapped = vessels.is_mapped();
  return {std::move(vessels), std::move(tree)};
}

double build_ms(const pipeline::VesselTree& tree, pipeline::ClusterArrays& arrays) {
  const auto begin = BenchClock::now();
  arrays = pipeline::build_clusters(tree);
  return 1000 * seconds_since(begin);
}

hal::Result<Loaded> grow(const VesselsBenchCommandLine& line) {
  ProgressLine progress{"growing"};
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  HAL_TRY(const auto grown,
          sim::generate_coronary_tree({line.segments, 1, cores},
                                      [&](double done) { progress.update(done); }));
  pipeline::ClusterArrays arrays;
  const double took_ms = build_ms(grown.tree, arrays);
  auto facts = pipeline::facts_of(grown.tree, arrays.error, "generated, seed 1");
  Loaded loaded =
      described(LoadedVessels{std::move(arrays), std::move(facts)}, "generated, seed 1");
  loaded.tree.build_ms = took_ms;
  return loaded;
}

hal::Result<Loaded> load(const VesselsBenchCommandLine& line) {
  ProgressLine progress{fmt::format("reading {}", line.file)};
  pipeline::TreeReadOptions reading = line.tree.options();
  reading.progress = [&](double done) { progress.update(done); };
  const auto begin = BenchClock::now();
  auto vessels = load_vessels(line.file, reading);
  const double load_ms = 1000 * seconds_since(begin);
  if (!vessels)
    return tl::make_unexpected(vessels.error());
  Loaded loaded = described(std::move(*vessels), line.file);
  loaded.tree.load_ms = load_ms;
  if (line.no_build)
    return loaded;
  HAL_TRY(const auto tree, pipeline::unpack_tree(loaded.vessels.clusters()));
  pipeline::ClusterArrays arrays;
  loaded.tree.build_ms = build_ms(tree, arrays);
  return loaded;
}

hal::Result<> bench(const VesselsBenchCommandLine& line) {
  HAL_TRY(const auto options, options_of(line));
  HAL_TRY(const auto loaded, line.file.empty() ? grow(line) : load(line));
  HAL_TRY(const auto report, bench_vessels(loaded.vessels.clusters(), options));
  if (line.as_json)
    say("{}\n", to_json(loaded.tree, report));
  else
    say("{}", to_text(loaded.tree, report));
  return {};
}

int run(const VesselsBenchCommandLine& line) {
  const auto done = bench(line);
  return done ? exit_done : complain(line.name, done.error());
}

std::vector<std::string> bench_method_names() {
  std::vector<std::string> names;
  for (const VesselBenchMethod& method : vessel_bench_methods())
    names.push_back(method.name);
  return names;
}

void add_options(CLI::App& command, VesselsBenchCommandLine& line) {
  add_tree_options(command, line.tree);
  command.add_flag("--json", line.as_json, "One JSON object");
  command.add_option("--size", line.size, "Of the pictures (1280x720 if not given)")
      ->type_name("WxH");
  command
      .add_option("--methods", line.methods,
                  "Only these, parted by commas; quads-brute-force draws what cannot be seen, too")
      ->delimiter(',')
      ->check(CLI::IsMember(bench_method_names()));
  command.add_option("--views", line.views, "Only these, parted by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(names_of(views_by_name())));
  command
      .add_option("--seconds", line.options.seconds,
                  "About how long each method is measured in each view")
      ->check(within(0.01, 3600.0))
      ->capture_default_str();
  command.add_option("--dump", line.dump, "Folder for each case's picture (PNG)")
      ->type_name("FOLDER");
  command.add_flag("--supersampled", line.options.supersampled,
                   "Compare with quads at four places within each pixel, too");
  command.add_flag(
      "--fly-through", line.fly_through,
      "Fly from the whole tree along the LAD to a close look, too: how far the hybrid is "
      "from quads, and whether anything pops up");
  command.add_option("--places", line.places, "At so many places of the flight, two frames each")
      ->check(within(1, 100'000))
      ->capture_default_str();
  command.add_flag("--no-build", line.no_build,
                   "Do not unpack the file and build its clusters again, to measure that");
}

} // namespace

void add_vessels_bench_command(CLI::App& vessels, int& exit_status) {
  CLI::App* command =
      vessels.add_subcommand("bench", "How fast each method draws a tree on this machine");
  auto line = std::make_shared<VesselsBenchCommandLine>();
  line->name = "vessels bench";
  command->add_option("file", line->file, "Vessel tree: our own format, SWC or VTP")
      ->required()
      ->type_name("FILE");
  add_options(*command, *line);
  command->footer(
      "Example: octascope vessels bench heart.vessels --json --methods quads-brute-force,hybrid");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

void add_bench_vessels_command(CLI::App& bench, int& exit_status) {
  CLI::App* command =
      bench.add_subcommand("vessels", "Milliseconds a picture of each way to draw a vessel tree");
  auto line = std::make_shared<VesselsBenchCommandLine>();
  line->name = "bench vessels";
  command->add_option("file", line->file, "Vessel tree; one is grown if not given")
      ->type_name("FILE");
  command->add_option("--segments", line->segments, "Of the tree that is grown")
      ->check(within(sim::fewest_coronary_segments, sim::most_coronary_segments))
      ->capture_default_str();
  add_options(*command, *line);
  command->footer("Example: octascope bench vessels --segments 1000000 --json");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

} // namespace octascope::firmware_host
