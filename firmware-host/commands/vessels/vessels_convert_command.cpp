// octascope vessels convert: a tree from one kind of file to another.
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/tree_options.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/report/progress_line.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/version/version.h"
#include "firmware-host/vessels/vessel_files.h"
#include "pipeline/vessels/files/tree_file.h"

namespace octascope::firmware_host {

namespace {

struct VesselsConvertCommandLine {
  std::filesystem::path file;
  std::filesystem::path out;
  TreeArguments tree;
};

std::string provenance_of(const pipeline::TreeFile& read, const std::filesystem::path& file) {
  if (const auto* facts = std::get_if<pipeline::VesselFacts>(&read.counts))
    return facts->provenance;
  return fmt::format("{}, lengths in {}, converted by octascope {}", file.filename().string(),
                     read.unit == pipeline::LengthUnit::um ? "um" : "mm", version());
}

hal::Result<> run(const VesselsConvertCommandLine& line) {
  pipeline::TreeReadOptions options = line.tree.options();
  auto read = [&] {
    ProgressLine progress{fmt::format("reading {}", line.file.string())};
    options.progress = [&](double done) { progress.update(done); };
    return pipeline::read_tree(line.file, options);
  }();
  if (!read)
    return tl::make_unexpected(read.error());
  {
    ProgressLine progress{fmt::format("writing {}", line.out.string())};
    HAL_CHECK(write_tree(line.out, read->tree, provenance_of(*read, line.file),
                         [&](double done) { progress.update(done); }));
  }
  say("{}: {} nodes written\n", line.out.string(), read->tree.nodes());
  return {};
}

} // namespace

void add_vessels_convert_command(CLI::App& vessels, int& exit_status) {
  CLI::App* command = vessels.add_subcommand(
      "convert", "A tree from one kind of file to another: SWC, VTP, our own");
  auto line = std::make_shared<VesselsConvertCommandLine>();
  command->add_option("file", line->file, "Vessel tree; its kind is told by its content")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--out", line->out,
                   "File to write: .vessels for our own format, .swc for SWC, .vtp for VTK")
      ->required()
      ->type_name("FILE.swc|.vtp|.vessels");
  add_tree_options(*command, line->tree);
  command->footer("The file appears complete or not at all. Our own format is eight times smaller, "
                  "is drawn without\nreading it first, and rounds places and radii: `vessels info` "
                  "says by how much.\n"
                  "Example: octascope vessels convert heart.swc --unit um --out heart.vessels");
  command->callback([line, &exit_status] {
    const auto done = run(*line);
    exit_status = done ? exit_done : complain("vessels convert", done.error());
  });
}

} // namespace octascope::firmware_host
