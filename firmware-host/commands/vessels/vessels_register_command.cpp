// octascope vessels register: where a tree lies in a volume, from pairs of points or from a live tree.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/command.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/commands/vessels/vessels_register.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/version/version.h"
#include "pipeline/files/text_curve.h"
#include "pipeline/vessels/point_registration.h"
#include "pipeline/vessels/registration.h"
#include "pipeline/vessels/registration_misfit.h"

namespace octascope::firmware_host {

namespace {

using pipeline::PointPair;
using pipeline::PointRegistration;

struct PairsOfFile {
  std::vector<PointPair> pairs;
  std::vector<std::size_t> lines; // where each stands, from 1
};

hal::Result<PairsOfFile> read_pairs(const std::filesystem::path& file) {
  constexpr std::size_t most = 10000;
  HAL_TRY(const auto rows, pipeline::read_text_rows(file, most, {6}));
  PairsOfFile read;
  for (const pipeline::TextRow& row : rows) {
    const auto& n = row.numbers;
    for (const double c : n)
      if (std::fabs(c) > pipeline::largest_coordinate_mm)
        return hal::fail(hal::ErrorCode::bad_data,
                         "{}:{}: found the coordinate {:g} mm, expected at most {:g} mm",
                         file.string(), row.line, c, pipeline::largest_coordinate_mm);
    read.pairs.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
    read.lines.push_back(row.line);
  }
  return read;
}

pipeline::Registration registration_of(const VesselsRegisterCommandLine& line,
                                       const PointRegistration& found,
                                       const std::optional<std::string>& misfit) {
  pipeline::RegistrationProvenance provenance;
  provenance.method = fmt::format("least squares of point pairs (Horn 1987){}{}",
                                  misfit ? "; misfit accepted: " : "", misfit.value_or(""));
  provenance.source = line.points.filename().string();
  provenance.points = static_cast<int>(found.residuals_mm.size());
  provenance.residual_mm = found.rms_mm;
  return registration_for(line, found.volume_from_tree, std::move(provenance));
}

std::string to_text(const PointRegistration& found, const PairsOfFile& read) {
  const bool left_out = found.left_out_rms_mm.has_value();
  std::string text = fmt::format("line  residual mm{}\n", left_out ? "  left out mm" : "");
  for (std::size_t i = 0; i < read.lines.size(); ++i)
    text += fmt::format("{:4}  {:11.4f}{}\n", read.lines[i], found.residuals_mm[i],
                        left_out ? fmt::format("  {:11.4f}", found.left_out_mm[i]) : "");
  text += fmt::format("residual {:.4f} mm rms over {} pairs, at most {:.4f} mm\n", found.rms_mm,
                      read.pairs.size(), found.largest_mm);
  text += left_out ? fmt::format("each pair is {:.4f} mm rms from where the others put it\n",
                                 *found.left_out_rms_mm)
                   : "too few pairs beside a line to tell how well they foretell each other; one "
                     "more would\n";
  for (std::size_t row = 0; row < 3; ++row) {
    const auto& r = found.volume_from_tree.rotation[row];
    text += fmt::format("[{:9.6f} {:9.6f} {:9.6f} {:10.4f}]\n", r[0], r[1], r[2],
                        found.volume_from_tree.shift_mm[row]);
  }
  return text;
}

std::string to_json(const PointRegistration& found, const VesselsRegisterCommandLine& line) {
  auto matrix = nlohmann::json::array();
  for (std::size_t row = 0; row < 3; ++row) {
    const auto& r = found.volume_from_tree.rotation[row];
    matrix.push_back({r[0], r[1], r[2], found.volume_from_tree.shift_mm[row]});
  }
  matrix.push_back({0, 0, 0, 1});
  nlohmann::json json{{"out", line.out.string()},
                      {"points", found.residuals_mm.size()},
                      {"volume_from_tree", matrix},
                      {"residual_mm", found.rms_mm},
                      {"largest_residual_mm", found.largest_mm},
                      {"residuals_mm", found.residuals_mm}};
  if (found.left_out_rms_mm) {
    json["left_out_mm"] = *found.left_out_rms_mm;
    json["left_outs_mm"] = found.left_out_mm;
  }
  return json.dump(2);
}

int run_points(const VesselsRegisterCommandLine& line) {
  const auto complain = [](std::string_view message) {
    warn("octascope vessels register: {}\n", message);
    return exit_failed;
  };
  const auto read = read_pairs(line.points);
  if (!read)
    return complain(read.error().message);
  const auto found = pipeline::register_points(read->pairs);
  if (!found)
    return complain(fmt::format("{}: {}", line.points.string(), found.error().message));
  const auto misfit = pipeline::misfit_of(read->pairs, *found);
  if (misfit && !line.accept_misfit)
    return complain(fmt::format("{}: no turn and shift brings the points together: {}; expected "
                                "both sides in mm and right-handed (--accept-misfit writes the "
                                "registration even so)",
                                line.points.string(), *misfit));
  if (const auto written =
          pipeline::write_registration(registration_of(line, *found, misfit), line.out);
      !written)
    return complain(written.error().message);
  if (misfit)
    warn("octascope vessels register: accepted: {}\n", *misfit);
  say("{}", line.json ? to_json(*found, line) + "\n" : to_text(*found, *read));
  return exit_done;
}

} // namespace

pipeline::Registration registration_for(const VesselsRegisterCommandLine& line,
                                        const pipeline::RigidTransform& volume_from_tree,
                                        pipeline::RegistrationProvenance provenance) {
  provenance.program = fmt::format("octascope {}", version());
  provenance.author = line.author;
  provenance.created = fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  return {.volume_from_tree = volume_from_tree,
          .whose = {.subject = line.subject,
                    .eye = pipeline::eye_named(line.eye).value_or(pipeline::Eye::not_said)},
          .provenance = std::move(provenance)};
}

void add_vessels_register_command(CLI::App& vessels, int& exit_status) {
  CLI::App* command = vessels.add_subcommand(
      "register",
      "Where a tree lies in an OCT volume, from pairs of points or from the vessels seen "
      "there");
  auto line = std::make_shared<VesselsRegisterCommandLine>();
  CLI::Option* points =
      command
          ->add_option(
              "--points", line->points,
              "Pairs of points, one a line: x y z in the tree, x y z in the volume, in mm, "
              "with commas, semicolons, blanks or tabs between them; # begins a comment. In "
              "the volume x runs along A-scans, y along B-scans, z along the depth, from the "
              "outer corner of the first voxel")
          ->type_name("FILE.csv");
  CLI::Option* tree =
      command
          ->add_option(
              "--tree", line->tree,
              "Instead of points: the tree to be registered, to the one of --to; turned by "
              "20 degrees and shifted by a third of the field at most")
          ->type_name("FILE.swc|.vtp|.vessels")
          ->excludes(points);
  CLI::Option* to =
      command
          ->add_option("--to", line->to,
                       "The tree that is seen, in the volume's frame, as vessels trace "
                       "writes it")
          ->type_name("FILE.swc|.vtp|.vessels")
          ->needs(tree);
  tree->needs(to);
  command
      ->add_option("--start", line->start,
                   "With --tree: about where it lies; else in the volume's frame, as one traced "
                   "before")
      ->type_name("FILE.toml")
      ->needs(tree);
  command->add_option("--out", line->out, "Registration to write")
      ->required()
      ->type_name("FILE.toml");
  command->add_option("--author", line->author, "Who marked the points; kept in the file")
      ->type_name("NAME");
  command
      ->add_option("--subject", line->subject,
                   "Whose vessels they are: they are then drawn in no other one's picture")
      ->type_name("ID");
  command->add_option("--eye", line->eye, "Of which eye")->check(CLI::IsMember({"left", "right"}));
  command
      ->add_flag("--accept-misfit", line->accept_misfit,
                 "Write what no turn and shift explains, too: another scale (by more than 5 %), "
                 "a mirrored side, a residual of more than half of the spread")
      ->needs(points);
  command->add_flag("--json", line->json, "The result as one JSON object");
  command->footer("At least three pairs that do not lie on a line; with four, each is also "
                  "compared with where the others put it.\n"
                  "Trees have at least 65 % of the vessels that are seen in common, or are refused "
                  "(docs/ANGIOGRAPHY.md).\n"
                  "Example: octascope vessels register --points pairs.csv --out registration.toml\n"
                  "         octascope vessels register --tree planned.swc --to live.swc --out "
                  "registration.toml");
  command->callback([line, points, tree, &exit_status] {
    if (points->empty() && tree->empty())
      throw CLI::RequiredError("--points, or --tree and --to");
    exit_status = tree->empty() ? run_points(*line) : register_trees(*line);
  });
}

} // namespace octascope::firmware_host
