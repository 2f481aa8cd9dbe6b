#include "ui/transfer/transfer_set.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace octascope::ui {

namespace {

std::vector<TransferFunction> built_in_functions() {
  // The points are constants within their ranges: neither curve can be refused.
  constexpr std::array<CurvePoint, 5> reflexes{
      {{0, 0}, {0.3F, 0}, {0.55F, 0.05F}, {0.8F, 0.35F}, {1, 1}}};
  constexpr std::array<CurvePoint, 4> solid{{{0, 0}, {0.05F, 0}, {0.2F, 1}, {1, 1}}};
  // Lifted, so that a body's form is seen before what it is made of.
  const ColourMap plaster{"surface", {{0.3F, 0.3F, 0.3F}, {1, 1, 1}}};
  std::vector<TransferFunction> functions;
  functions.push_back({"window", TransferCurve::ramp(), {}});
  functions.push_back({"smooth", *TransferCurve::spline(reflexes), {}});
  functions.push_back({"surface", *TransferCurve::piecewise(solid), plaster});
  return functions;
}

template <typename Items> auto find_index(const Items& items, auto&& is_it) {
  const auto found = std::ranges::find_if(items, is_it);
  return found == items.end() ? std::optional<int>{}
                              : std::optional{static_cast<int>(found - items.begin())};
}

template <typename Item> const Item& at_or_first(std::span<const Item> items, int index) {
  const auto i = static_cast<std::size_t>(index);
  return items[index >= 0 && i < items.size() ? i : 0];
}

} // namespace

TransferSet::TransferSet()
    : TransferSet{Contents{built_in_functions(),
                           {ColourMap::grey(), ColourMap::amber(), ColourMap::blue_green(),
                            ColourMap::dawn(), ColourMap::depth()}}} {}

TransferSet::TransferSet(Contents contents)
    : contents_{std::make_shared<const Contents>(std::move(contents))} {}

hal::Result<TransferSet> TransferSet::with(std::vector<TransferFunction> functions) const {
  TransferSet grown = *this;
  for (TransferFunction& function : functions) {
    if (grown.function_named(function.name))
      return hal::fail(hal::ErrorCode::invalid_argument,
                       "a transfer function \"{}\" is there already; choose another name",
                       function.name);
    Contents contents = *grown.contents_;
    contents.functions.push_back(std::move(function));
    grown = TransferSet{std::move(contents)};
  }
  return grown;
}

ChoiceNames TransferSet::names() const {
  ChoiceNames names{{}, {}};
  for (const TransferFunction& function : functions())
    names.transfers.push_back(function.name);
  for (const ColourMap& map : colour_maps())
    names.colours.emplace_back(map.name());
  return names;
}

std::optional<int> TransferSet::function_named(std::string_view name) const {
  return find_index(functions(), [&](const TransferFunction& f) { return f.name == name; });
}

std::optional<int> TransferSet::colour_map_named(std::string_view name) const {
  return find_index(colour_maps(), [&](const ColourMap& map) { return map.name() == name; });
}

const TransferFunction& TransferSet::function(const ViewState& view) const {
  return at_or_first(functions(), view.transfer);
}

const ColourMap& TransferSet::colours(const ViewState& view) const {
  const ColourMap& map = at_or_first(colour_maps(), view.colour_map);
  const TransferFunction& chosen = function(view);
  return &map == &colour_maps().front() && chosen.colours ? *chosen.colours : map;
}

void make_transfer_table(const ViewState& view, const TransferSet& set, TransferTable& table) {
  const TransferFunction& function = set.function(view);
  const ColourMap& colours = set.colours(view);
  if (function.curve.is_ramp() && &colours == &set.colour_maps().front()) {
    make_window_table(view, table);
    return;
  }
  const WindowRamp window = window_ramp(view);
  for (std::size_t i = 0; i < TransferTable::entries; ++i) {
    const float level = static_cast<float>(i) / TransferTable::entries_per_level;
    const float u = std::clamp(level / 255 * window.scale + window.offset, 0.0F, 1.0F);
    table.colour[i] = colours.at(u);
    table.opacity[i] = function.curve.opacity(u) * view.opacity;
  }
  table.depths = colours.by_depth() ? std::optional{DepthColours{}} : std::nullopt;
  table.window.reset();
}

} // namespace octascope::ui
