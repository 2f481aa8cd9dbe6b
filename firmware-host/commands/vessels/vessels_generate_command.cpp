// octascope vessels generate: a heart's arteries, drawn by lot from what was measured.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/vessels/morphometry_json.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/report/progress_line.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/vessels/vessel_files.h"
#include "sim/coronary_tree/coronary_tree.h"
#include "sim/coronary_tree/morphometry_table.h"

namespace octascope::firmware_host {

namespace {

using nlohmann::ordered_json;

struct VesselsGenerateCommandLine {
  std::uint32_t segments = 0;
  std::uint64_t seed = 1;
  std::string out;
  std::size_t threads = 0; // 0: one a core
  bool json = false;
};

void print_json(const VesselsGenerateCommandLine& line, const sim::CoronaryTree& coronary,
                double seconds) {
  const sim::MorphometryTable table = sim::compare_with_published(coronary);
  ordered_json json{{"segments", line.segments},
                    {"nodes", coronary.tree.nodes()},
                    {"seed", line.seed},
                    {"seconds", seconds},
                    {"scale_factor", table.whole_factor},
                    {"growth_per_order", table.growth},
                    {"lowest_order", coronary.lowest_order},
                    {"murray_ratio_below_50_um", table.murray_ratio}};
  json["table"] = morphometry_json(table);
  say("{}\n", json.dump(2));
}

hal::Result<> run(const VesselsGenerateCommandLine& line) {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const sim::CoronaryTreeRequest request{line.segments, line.seed,
                                         line.threads > 0 ? line.threads : cores};
  HAL_TRY(auto coronary, [&] {
    ProgressLine progress{"growing"};
    return sim::generate_coronary_tree(request, [&](double done) { progress.update(done); });
  }());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  {
    ProgressLine progress{"writing"};
    HAL_CHECK(write_tree(
        line.out, coronary.tree,
        fmt::format("octascope vessels generate --segments {} --seed {}", line.segments, line.seed),
        [&](double done) { progress.update(done); }));
  }
  if (line.json) {
    print_json(line, coronary, took.count());
    return {};
  }
  say("{} segments, {} nodes, seed {}, grown in {:.1f} s\n\n{}", line.segments,
      coronary.tree.nodes(), line.seed, took.count(),
      sim::to_text(sim::compare_with_published(coronary)));
  return {};
}

} // namespace

void add_vessels_generate_command(CLI::App& vessels, int& exit_status) {
  CLI::App* command = vessels.add_subcommand(
      "generate", "A pig's coronary arteries by the published morphometry, from a seed");
  auto line = std::make_shared<VesselsGenerateCommandLine>();
  command
      ->add_option("--segments", line->segments,
                   fmt::format("Exactly so many, {} to {}", sim::fewest_coronary_segments,
                               sim::most_coronary_segments))
      ->required()
      ->check(within(sim::fewest_coronary_segments, sim::most_coronary_segments))
      ->type_name("N");
  command->add_option("--seed", line->seed, "The same seed gives the same file (1 if not given)")
      ->check(within(std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max()))
      ->type_name("S");
  command
      ->add_option("--out", line->out, "File to write: .swc for SWC, else our own format, .vessels")
      ->required()
      ->type_name("FILE.swc|.vessels");
  command->add_option("--threads", line->threads, "One a core if not given; changes only the time")
      ->check(within(1, 1024))
      ->type_name("N");
  command->add_flag("--json", line->json, "The table as one JSON object");
  command->footer(
      "Prints what was achieved beside what was published, and the declared scale factor.\n"
      "Example: octascope vessels generate --segments 11000000 --seed 1 --out heart.vessels");
  command->callback([line, &exit_status] {
    const auto done = run(*line);
    exit_status = done ? exit_done : complain("vessels generate", done.error());
  });
}

} // namespace octascope::firmware_host
