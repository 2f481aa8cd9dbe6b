#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/vessels/vessels_register.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/vessels/files/tree_file.h"
#include "pipeline/vessels/following/tree_registration.h"

namespace octascope::firmware_host {

namespace {

using pipeline::TreeRegistration;
using pipeline::VesselTree;

hal::Result<VesselTree> tree_of(const std::filesystem::path& file) {
  pipeline::TreeReadOptions options;
  options.forest = true;
  HAL_TRY(auto read, pipeline::read_tree(file, options));
  if (read.tree.nodes() == 0)
    return hal::fail(hal::ErrorCode::bad_data, "{}: found no vessels, expected some",
                     file.string());
  return std::move(read.tree);
}

// The field is not known: a live tree that has moved no longer fills it, and a planned one may be
// larger by far.
pipeline::PoseReach reach_of(const VesselTree& planned, const VesselTree& live) {
  const double planned_mm = pipeline::box_around(planned).longest_side();
  const double live_mm = pipeline::box_around(live).longest_side();
  return pipeline::first_reach(std::clamp(planned_mm, live_mm, 1.5 * live_mm));
}

std::string tree_text(const TreeRegistration& found, double seconds) {
  std::string text = fmt::format(
      "overlap {:.0f} %: of the vessels of --to, where the tree reaches; {:.0f} % the other way\n"
      "residual {:.4f} mm rms across vessels\n"
      "found in {:.2f} s; leads the next best place by {:.2f}\n",
      found.overlap * 100, found.planned_overlap * 100, found.residual_mm, seconds, found.lead);
  for (std::size_t row = 0; row < 3; ++row) {
    const auto& r = found.live_from_planned.rotation[row];
    text += fmt::format("[{:9.6f} {:9.6f} {:9.6f} {:10.4f}]\n", r[0], r[1], r[2],
                        found.live_from_planned.shift_mm[row]);
  }
  return text;
}

std::string tree_json(const TreeRegistration& found, double seconds,
                      const VesselsRegisterCommandLine& line) {
  auto matrix = nlohmann::json::array();
  for (std::size_t row = 0; row < 3; ++row) {
    const auto& r = found.live_from_planned.rotation[row];
    matrix.push_back({r[0], r[1], r[2], found.live_from_planned.shift_mm[row]});
  }
  matrix.push_back({0, 0, 0, 1});
  return nlohmann::json{{"out", line.out.string()},
                        {"volume_from_tree", matrix},
                        {"residual_mm", found.residual_mm},
                        {"overlap", found.overlap},
                        {"planned_overlap", found.planned_overlap},
                        {"lead", found.lead},
                        {"seconds", seconds}}
             .dump(2) +
         "\n";
}

hal::Result<> register_and_write(const VesselsRegisterCommandLine& line) {
  HAL_TRY(const auto planned, tree_of(line.tree));
  HAL_TRY(const auto live, tree_of(line.to));
  pipeline::RigidTransform start;
  if (!line.start.empty()) {
    HAL_TRY(const auto before, pipeline::Registration::load(line.start));
    start = before.volume_from_tree;
  }
  const auto begun = std::chrono::steady_clock::now();
  const TreeRegistration found =
      pipeline::register_trees(planned, live, start, reach_of(planned, live));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  if (!found.refusal.empty())
    return hal::fail(hal::ErrorCode::bad_data, "{}: not registered to {}: {}", line.tree.string(),
                     line.to.string(), found.refusal);
  pipeline::RegistrationProvenance provenance;
  provenance.method = fmt::format("vessels registered to vessels, overlap {:.2f}", found.overlap);
  provenance.source =
      fmt::format("{} to {}", line.tree.filename().string(), line.to.filename().string());
  provenance.residual_mm = found.residual_mm;
  HAL_CHECK(pipeline::write_registration(
      registration_for(line, found.live_from_planned, std::move(provenance)), line.out));
  say("{}", line.json ? tree_json(found, took.count(), line) : tree_text(found, took.count()));
  return {};
}

} // namespace

int register_trees(const VesselsRegisterCommandLine& line) {
  const auto done = register_and_write(line);
  return done ? exit_done : complain("vessels register", done.error());
}

} // namespace octascope::firmware_host
