// octascope vessels generate: a heart's arteries, drawn by lot from what was measured.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/vessels/morphometry_json.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/report/progress_line.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/version/version.h"
#include "firmware-host/vessels/vessel_files.h"
#include "pipeline/vessels/registration.h"
#include "pipeline/vessels/tree_summary.h"
#include "sim/coronary_tree/coronary_tree.h"
#include "sim/coronary_tree/morphometry_table.h"
#include "sim/phantoms/phantom_tree.h"

namespace octascope::firmware_host {

namespace {

using nlohmann::ordered_json;

struct VesselsGenerateCommandLine {
  std::uint32_t segments = 0;
  std::uint64_t seed = 1;
  std::string phantom; // empty: coronary arteries
  std::string out;
  std::string registration; // empty: none is written
  std::size_t threads = 0;  // 0: one a core
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

hal::Result<> write_phantom_registration(const VesselsGenerateCommandLine& line,
                                         const pipeline::RigidTransform& volume_from_tree) {
  pipeline::Registration registration;
  registration.volume_from_tree = volume_from_tree;
  registration.provenance = {
      .program = fmt::format("octascope {}", version()),
      .author = "",
      .created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))),
      .method = "the phantom's own place, exact",
      .source = fmt::format("phantom {}", line.phantom),
      .points = 0,
      .residual_mm = 0};
  return pipeline::write_registration(registration, line.registration);
}

// The vessels that a simulated camera sees in a phantom.
hal::Result<> generate_phantom(const VesselsGenerateCommandLine& line) {
  HAL_TRY(const auto phantom, sim::make_phantom(line.phantom, line.seed));
  const sim::PhantomTree made = sim::phantom_tree(*phantom);
  HAL_CHECK(write_tree(
      line.out, made.tree,
      fmt::format("octascope vessels generate --phantom {} --seed {}", line.phantom, line.seed)));
  if (!line.registration.empty())
    HAL_CHECK(write_phantom_registration(line, made.volume_from_tree));
  const pipeline::TreeSummary summary = pipeline::summarise(made.tree);
  if (line.json) {
    const ordered_json json{{"phantom", line.phantom},
                            {"segments", summary.segments},
                            {"nodes", summary.nodes},
                            {"seed", line.seed}};
    say("{}\n", json.dump(2));
    return {};
  }
  say("{} segments, {} nodes, the vessels of the phantom {}, seed {}\n", summary.segments,
      summary.nodes, line.phantom, line.seed);
  return {};
}

hal::Result<> run(const VesselsGenerateCommandLine& line) {
  if (!line.phantom.empty())
    return generate_phantom(line);
  if (line.segments == 0)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "neither --segments nor --phantom is given, expected one of them");
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
      "generate", "A pig's coronary arteries by the published morphometry, or a phantom's vessels");
  auto line = std::make_shared<VesselsGenerateCommandLine>();
  CLI::Option* segments =
      command
          ->add_option("--segments", line->segments,
                       fmt::format("Coronary arteries, of exactly so many, {} to {}",
                                   sim::fewest_coronary_segments, sim::most_coronary_segments))
          ->check(within(sim::fewest_coronary_segments, sim::most_coronary_segments))
          ->type_name("N");
  CLI::Option* phantom =
      command
          ->add_option("--phantom", line->phantom,
                       "The vessels that run --sim shows of this phantom, in the volume's size")
          ->check(CLI::IsMember(
              std::vector<std::string>(sim::phantom_names.begin(), sim::phantom_names.end())))
          ->excludes(segments);
  command
      ->add_option("--registration", line->registration,
                   "Registration to write, too: where they lie in the phantom's volume")
      ->type_name("FILE.toml")
      ->needs(phantom);
  command->add_option("--seed", line->seed, "The same seed gives the same file (1 if not given)")
      ->check(within(std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max()))
      ->type_name("S");
  command
      ->add_option("--out", line->out,
                   "File to write: .vessels for our own format, .swc for SWC, .vtp for VTK")
      ->required()
      ->type_name("FILE.swc|.vtp|.vessels");
  command->add_option("--threads", line->threads, "One a core if not given; changes only the time")
      ->check(within(1, 1024))
      ->type_name("N");
  command->add_flag("--json", line->json, "The table as one JSON object");
  command->footer(
      "Prints what was achieved beside what was published, and the declared scale factor.\n"
      "Examples:\n"
      "  octascope vessels generate --segments 11000000 --seed 1 --out heart.vessels\n"
      "  octascope vessels generate --phantom anterior_eye --out eye.vessels \\\n"
      "    --registration eye.toml");
  command->callback([line, &exit_status] {
    const auto done = run(*line);
    exit_status = done ? exit_done : complain("vessels generate", done.error());
  });
}

} // namespace octascope::firmware_host
