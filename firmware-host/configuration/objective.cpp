#include "firmware-host/configuration/objective.h"

#include <algorithm>

#include <fmt/format.h>

namespace octascope::firmware_host {

namespace {

constexpr pipeline::NumberRange scan_sizes_mm{0.01, 1000};
constexpr std::size_t longest_name = 24; // that the display has room for

std::optional<Objective> read_objective(pipeline::ConfigTable& entry) {
  Objective objective;
  objective.name = entry.text("name", "");
  if (objective.name.empty() || objective.name.size() > longest_name) {
    entry.complain("name is missing, empty or longer than 24 bytes, expected one to choose it by");
    return std::nullopt;
  }
  if (entry.has("a_mm"))
    objective.a_mm = entry.number("a_mm", 1, scan_sizes_mm);
  if (entry.has("b_mm"))
    objective.b_mm = entry.number("b_mm", 1, scan_sizes_mm);
  objective.calibration = entry.path("calibration");
  objective.window = read_window(entry);
  return objective;
}

} // namespace

void Objective::scale(pipeline::ScanPlan& plan) const {
  constexpr double um_per_mm = 1000;
  if (a_mm) {
    plan.a_spacing_um = *a_mm * um_per_mm / plan.a_scans;
    plan.assumed_spacings.a_scans = false;
  }
  if (b_mm) {
    plan.b_spacing_um = *b_mm * um_per_mm / plan.b_scans;
    plan.assumed_spacings.b_scans = false;
  }
}

std::optional<ui::DisplayWindow> read_window(pipeline::ConfigTable& table) {
  if (table.has("window_offset_db") != table.has("window_size_db"))
    table.complain("window_offset_db and window_size_db go together: give both or neither");
  const double offset_db = table.number("window_offset_db", 0, window_offset_range_db);
  const double size_db = table.number("window_size_db", 1, window_size_range_db);
  if (!table.has("window_offset_db"))
    return std::nullopt;
  return ui::DisplayWindow{static_cast<float>(offset_db), static_cast<float>(size_db)};
}

std::vector<Objective> read_objectives(pipeline::ConfigTable root) {
  std::vector<Objective> objectives;
  for (pipeline::ConfigTable& entry : root.tables("objective")) {
    auto objective = read_objective(entry);
    if (!objective)
      continue;
    const bool known = std::ranges::any_of(
        objectives, [&](const Objective& o) { return o.name == objective->name; });
    if (known)
      entry.complain("name \"{}\" is there twice, expected a name of its own", objective->name);
    objectives.push_back(std::move(*objective));
  }
  return objectives;
}

std::optional<Objective> chosen_objective(pipeline::ConfigTable microscope,
                                          const std::vector<Objective>& objectives) {
  const std::string name = microscope.text("objective", "");
  const auto found = std::ranges::find(objectives, name, &Objective::name);
  if (found != objectives.end())
    return *found;
  if (objectives.empty() && name.empty())
    return std::nullopt;
  std::string names;
  for (const Objective& objective : objectives)
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", objective.name);
  microscope.complain(objectives.empty()
                          ? fmt::format("objective is \"{}\", but there is no [[objective]]", name)
                          : fmt::format("objective is {}, expected one of {}",
                                        name.empty() ? "missing" : '"' + name + '"', names));
  return std::nullopt;
}

} // namespace octascope::firmware_host
