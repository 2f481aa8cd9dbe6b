#include "firmware-host/configuration/look_configuration.h"

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "ui/transfer/look_up_table_file.h"

namespace octascope::firmware_host {

namespace {

using pipeline::ConfigTable;
using ui::ColourMap;
using ui::TransferCurve;
using ui::TransferFunction;
using ui::TransferSet;

enum Kind : std::size_t { piecewise, spline, table };

template <typename Items> std::string list_names(const Items& items, auto&& name_of) {
  std::string names;
  for (const auto& item : items)
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", name_of(item));
  return names;
}

int read_colour_map(ConfigTable& place, const TransferSet& set) {
  const std::string name = place.text("colours", "grey");
  if (const auto index = set.colour_map_named(name))
    return *index;
  place.complain("colours is \"{}\", expected one of {}", name,
                 list_names(set.colour_maps(), [](const ColourMap& m) { return m.name(); }));
  return 0;
}

hal::Result<TransferCurve> read_points(ConfigTable& entry, Kind kind) {
  std::vector<ui::CurvePoint> points;
  for (const auto& row : entry.rows("points", 2))
    points.push_back({static_cast<float>(row[0]), static_cast<float>(row[1])});
  auto curve = kind == spline ? TransferCurve::spline(points) : TransferCurve::piecewise(points);
  if (!curve)
    return hal::fail(curve.error().code, "points: " + curve.error().message);
  return curve;
}

// The file's own colours, where it has any, go to `colours`.
hal::Result<TransferCurve> read_table(ConfigTable& entry, const std::string& name,
                                      std::optional<ColourMap>& colours) {
  const auto file = entry.path("file");
  if (!file)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "file is missing, expected the look-up table's, as in file = \"look.csv\"");
  HAL_TRY(auto read, ui::read_look_up_table(*file));
  if (read.colours)
    colours = ColourMap{name, std::move(*read.colours)};
  return TransferCurve::table(read.opacities);
}

std::optional<TransferFunction> read_function(ConfigTable entry, const TransferSet& set) {
  const std::string name = entry.text("name", "");
  if (name.empty() || name.size() > 24) {
    entry.complain("name is missing, empty or longer than 24 bytes, expected one to choose it by");
    return std::nullopt;
  }
  const auto kind =
      static_cast<Kind>(entry.choice("kind", piecewise, {"piecewise", "spline", "table"}));
  std::optional<ColourMap> colours;
  if (entry.has("colours"))
    colours = set.colour_maps()[static_cast<std::size_t>(read_colour_map(entry, set))];
  std::optional<ColourMap> of_file;
  auto curve = kind == table ? read_table(entry, name, of_file) : read_points(entry, kind);
  if (!curve) {
    entry.complain(curve.error().message);
    return std::nullopt;
  }
  if (colours && of_file) {
    entry.complain("colours: the file has colours of its own; leave one of them out");
    return std::nullopt;
  }
  return TransferFunction{name, std::move(*curve), of_file ? of_file : colours};
}

TransferSet read_functions(ConfigTable root) {
  TransferSet set;
  for (ConfigTable& entry : root.tables("transfer")) {
    auto function = read_function(entry, set);
    if (!function)
      continue;
    std::vector<TransferFunction> one;
    one.push_back(std::move(*function));
    if (auto grown = set.with(std::move(one)))
      set = std::move(*grown);
    else
      entry.complain(grown.error().message);
  }
  return set;
}

int read_transfer(ConfigTable& display, const TransferSet& set) {
  const std::string name = display.text("transfer", "window");
  if (const auto index = set.function_named(name))
    return *index;
  display.complain("transfer is \"{}\", expected one of {}", name,
                   list_names(set.functions(), [](const TransferFunction& f) { return f.name; }));
  return 0;
}

ui::Technique read_technique(ConfigTable& display, ui::Technique fallback) {
  const std::string name = display.text("technique", ui::to_string(fallback));
  if (const auto technique = ui::technique_named(name))
    return *technique;
  display.complain(
      "technique is \"{}\", expected one of {}", name,
      list_names(ui::all_techniques, [](ui::Technique t) { return ui::to_string(t); }));
  return fallback;
}

} // namespace

LookConfiguration read_look(ConfigTable root, ConfigTable display) {
  LookConfiguration look;
  look.transfers = read_functions(root);
  look.transfer = read_transfer(display, look.transfers);
  look.colour_map = read_colour_map(display, look.transfers);
  look.technique = read_technique(display, look.technique);
  look.opacity =
      static_cast<float>(display.number("opacity", static_cast<double>(look.opacity), {0.01, 1}));
  look.rolling = display.boolean("rolling", look.rolling);
  return look;
}

} // namespace octascope::firmware_host
