// octascope vessels render: a picture of a vessel tree.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/tree_options.h"
#include "firmware-host/commands/vessels/vessel_text.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/commands/vessels/vessels_render.h"
#include "firmware-host/report/progress_line.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/vessels/vessel_source.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

namespace {

struct VesselsRenderCommandLine {
  std::string file;
  TreeArguments tree;
  std::string out;
  std::string size;
  std::string method = "hybrid";
  std::string view = "whole";
  std::string branch;
  std::string colour = "branch";
  std::vector<float> target_mm;
  VesselsRenderOptions options;
};

hal::Result<VesselsRenderOptions> options_of(const VesselsRenderCommandLine& line) {
  VesselsRenderOptions options = line.options;
  options.method = *ui::vessel_method_named(line.method);
  options.view = views_by_name().at(line.view);
  options.colouring = colourings_by_name().at(line.colour);
  if (!line.branch.empty())
    options.branch = branches_by_name().at(line.branch);
  if (!line.target_mm.empty())
    options.target_mm = {line.target_mm[0], line.target_mm[1], line.target_mm[2]};
  if (!line.size.empty()) {
    HAL_TRY(const auto size, parse_size(line.size));
    options.width = size[0];
    options.height = size[1];
  }
  return options;
}

hal::Result<> render(const VesselsRenderCommandLine& line) {
  HAL_TRY(const auto options, options_of(line));
  // Said before the work, not after it.
  HAL_CHECK(pipeline::AtomicFile::create(line.out));
  const auto vessels = [&] {
    ProgressLine progress{fmt::format("reading {}", line.file)};
    pipeline::TreeReadOptions reading = line.tree.options();
    reading.progress = [&](double done) { progress.update(done); };
    return load_vessels(line.file, reading);
  }();
  if (!vessels)
    return tl::make_unexpected(vessels.error());
  HAL_TRY(const auto rendering, render_vessels(vessels->clusters(), options));
  warn("{}: {}\n{}\n", line.method, describe(rendering.account), describe(rendering.view));
  return pipeline::write_png(line.out, rendering.picture);
}

int run(const VesselsRenderCommandLine& line) {
  const auto done = render(line);
  return done ? exit_done : complain("vessels render", done.error());
}

void add_view_options(CLI::App& command, VesselsRenderCommandLine& line) {
  VesselsRenderOptions& options = line.options;
  command
      .add_option("--view", line.view,
                  "Where the look begins: the whole tree, where most is seen at 20 µm a pixel, or "
                  "close by where the capillaries are densest")
      ->check(CLI::IsMember(names_of(views_by_name())))
      ->capture_default_str();
  command.add_option("--yaw", options.yaw_deg, "Degrees about the tree's y axis (35 if not given)")
      ->check(within(-360.0, 360.0));
  command.add_option("--tilt", options.tilt_deg, "Degrees from above (15 if not given)")
      ->check(within(-90.0, 90.0));
  command
      .add_option("--target", line.target_mm, "What is looked at, in mm; the view's if not given")
      ->delimiter(',')
      ->check(within(-1e6F, 1e6F))
      ->expected(3)
      ->type_name("X,Y,Z");
  command
      .add_option("--mm-per-pixel", options.mm_per_pixel, "At the target; the view's if not given")
      ->check(within(1e-5, 1e3));
  command.add_option("--zoom", options.zoom, "So many times nearer")
      ->check(within(1e-3, 1e6))
      ->capture_default_str();
}

void add_picture_options(CLI::App& command, VesselsRenderCommandLine& line) {
  command.add_option("--method", line.method, "How it is drawn")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  command.add_option("--sectors", line.options.tubes.sectors, "Of tubes: even, 4 to 32")
      ->check(within(4, 32))
      ->check([](const std::string& text) {
        return (text.back() - '0') % 2 == 0
                   ? std::string{}
                   : fmt::format("found {}, expected an even number from 4 to 32", text);
      })
      ->capture_default_str();
  command.add_option("--branch", line.branch, "Only that one (all if not given)")
      ->check(CLI::IsMember(names_of(branches_by_name())));
  command
      .add_option("--colour", line.colour,
                  "By branch, by order, or by who drew it: red GL, white the processor")
      ->check(CLI::IsMember(names_of(colourings_by_name())))
      ->capture_default_str();
  command.add_option("--size", line.size, "Of the picture in pixels (1280x720 if not given)")
      ->type_name("WxH");
  command.add_option("--out", line.out, "Picture to write")->required()->type_name("FILE.png");
}

} // namespace

void add_vessels_render_command(CLI::App& vessels, int& exit_status) {
  CLI::App* command = vessels.add_subcommand("render", "A picture of a vessel tree (PNG)");
  auto line = std::make_shared<VesselsRenderCommandLine>();
  command->add_option("file", line->file, "Vessel tree: our own format, SWC or VTP")
      ->required()
      ->type_name("FILE");
  add_tree_options(*command, line->tree);
  add_view_options(*command, *line);
  add_picture_options(*command, *line);
  command->footer(
      "Examples:\n"
      "  octascope vessels render heart.vessels --yaw 120 --out heart.png\n"
      "  octascope vessels render heart.vessels --branch lad --colour order --out lad.png\n"
      "  octascope vessels render heart.vessels --view close --method tubes-gpu \\\n"
      "    --sectors 16 --zoom 2 --out capillaries.png");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

} // namespace octascope::firmware_host
