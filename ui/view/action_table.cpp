#include "ui/view/action_table.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "hal/display.h"

namespace octascope::ui {

namespace {

using hal::Key;
using enum ActionKind;
using namespace trait;

constexpr ActionKey key(std::uint16_t key, int step = 0) {
  return {key, step};
}
constexpr ActionKey back(std::uint16_t key) {
  return {key, -1};
}
constexpr ActionKey forth(std::uint16_t key) {
  return {key, 1};
}
constexpr std::uint16_t code(Key key) {
  return static_cast<std::uint16_t>(key);
}

template <class... Keys> constexpr std::array<ActionKey, most_keys> keys(Keys... each) {
  return {each...};
}

ValueText text(fmt::format_string<float&> pattern, float value) {
  ValueText words;
  words.format(pattern, value);
  return words;
}

ValueText decibels(float value) {
  return text("{:.0f} dB", value);
}
ValueText decibels_or_off(float value) {
  return value > 0 ? decibels(value) : text("off", value);
}
ValueText degrees(float value) {
  return text("{:.0f}°", value);
}
ValueText fine_degrees(float value) {
  return text("{:.2f}°", value);
}
ValueText plain(float value) {
  return text("{:.2f}", value);
}
ValueText counted_from_one(float index) {
  return text("{:.0f}", index + 1);
}
ValueText percent(float share) {
  return text("{:.0f} %", share * 100);
}
ValueText signed_millimetres(float mm) {
  return text("{:+.2f} mm", mm);
}
ValueText signed_degrees(float value) {
  return text("{:+.1f}°", value);
}

// `detent` voxels a detent.
template <auto Count> constexpr Number index_along(int ViewState::*index, float detent) {
  return {
      .index = index, .count = Count, .range = {0, last_index, detent}, .words = counted_from_one};
}
constexpr Number shift_along(std::size_t axis) {
  return {.nudge = &VesselNudge::shift_mm,
          .axis = axis,
          .range = {-50, 50, 0.02F},
          .words = signed_millimetres};
}
constexpr Number turn_about(std::size_t axis) {
  return {.nudge = &VesselNudge::turn_deg,
          .axis = axis,
          .range = {-180, 180, 0.5F},
          .words = signed_degrees,
          .cyclic = true};
}

template <auto Member> constexpr Choice one_of(std::span<const ChoiceValue> values) {
  return {[](const ViewState& view) { return static_cast<std::size_t>(view.*Member); },
          [](ViewState& view, std::size_t value) {
            view.*Member = static_cast<std::remove_reference_t<decltype(view.*Member)>>(value);
          },
          values};
}

// clang-format off
constexpr std::array<ActionRow, action_count> table{{
    {Action::window_offset, "window_offset", "Window offset", continuous, keys(key('o')),
     Number{.number = &ViewState::window_offset_db, .range = {-40, 87, 1}, .words = decibels},
     "window_offset_db", drawn | home | kept},
    {Action::window_size, "window_size", "Window size", continuous, keys(key('s')),
     Number{.number = &ViewState::window_size_db, .range = {1, 128, 1}, .words = decibels},
     "window_size_db", drawn | home | kept},
    {Action::auto_window, "auto_window", "Automatic window", momentary, keys(key('w')), {}, {}},

    {Action::rotate, "rotate", "Rotation", continuous,
     keys(back(code(Key::left)), forth(code(Key::right))),
     Number{.number = &ViewState::yaw_deg, .range = {-180, 180, 3}, .words = degrees, .cyclic = true},
     "yaw_deg", drawn | home},
    {Action::tilt, "tilt", "Tilt", continuous, keys(forth(code(Key::up)), back(code(Key::down))),
     Number{.number = &ViewState::tilt_deg, .range = {-89, 89, 3}, .words = degrees},
     "tilt_deg", drawn | home},
    {Action::distance, "distance", "Distance", continuous,
     keys(back(code(Key::page_up)), forth(code(Key::page_down)), back('+'), back('='), forth('-')),
     Number{.number = &ViewState::distance, .range = {0.6F, 8, 0.05F}, .words = plain},
     "distance", drawn | home},
    {Action::reset_view, "reset_view", "First view", momentary, keys(key(code(Key::home))), {}, {}},

    {Action::next_parameter, "next_parameter", "Next function", choice,
     keys(key(code(Key::tab))), {}, {}},
    {Action::previous_parameter, "previous_parameter", "Previous function", choice, keys(), {}, {}},
    {Action::adjust, "adjust", "Adjust", continuous, keys(), {}, {}},

    {Action::freeze, "freeze", "Freeze", toggle, keys(key(code(Key::space))),
     Flag{&ViewState::frozen, "frozen", "live"}, "frozen"},
    {Action::rolling, "rolling", "Rolling volume", toggle, keys(key('*')),
     Flag{&ViewState::rolling, "each B-scan as it comes", "whole volumes"}, "rolling", kept},
    {Action::technique, "technique", "Technique", choice, keys(key('t')),
     one_of<&ViewState::technique>(technique_values), "technique", drawn | home | kept},
    {Action::transfer, "transfer", "Transfer", choice, keys(key('f')),
     NamedChoice{&ViewState::transfer, &ChoiceNames::transfers}, "transfer", drawn | home | kept},
    {Action::colours, "colours", "Colours", choice, keys(key('c')),
     NamedChoice{&ViewState::colour_map, &ChoiceNames::colours}, "colours", drawn | home | kept},
    {Action::opacity, "opacity", "Opacity", continuous, keys(key('\\')),
     Number{.number = &ViewState::opacity, .range = {0.01F, 1, 0.05F}, .words = percent},
     "opacity", drawn | home | kept},
    {Action::see_through, "see_through", "See through", continuous, keys(key('/')),
     Number{.number = &ViewState::see_through_db, .range = {0, 30, 1}, .words = decibels_or_off},
     "see_through_db", drawn | home | kept},
    {Action::layout, "layout", "Layout", choice, keys(key('l')),
     one_of<&ViewState::layout>(layout_values), "layout", drawn | home | kept},
    {Action::stereo, "stereo", "Stereo", choice, keys(key('d')),
     one_of<&ViewState::stereo>(stereo_values), "stereo", drawn | kept},
    {Action::parallax, "parallax", "Parallax", continuous, keys(key('x')),
     Number{.number = &ViewState::parallax_deg, .range = {-10, 10, 0.25F}, .words = fine_degrees},
     "parallax_deg", drawn | kept | needs_stereo},
    {Action::b_scan, "b_scan", "B-scan", continuous, keys(back('['), forth(']')),
     index_along<&Geometry::b_scans>(&ViewState::b_scan, 1), "b_scan", home},
    {Action::cut, "cut", "Cut", choice, keys(key('4')),
     one_of<&ViewState::cut>(cut_values), "cut", drawn | home},
    {Action::crossed_b_scan, "crossed_b_scan", "Crossed B-scan", continuous,
     keys(back(';'), forth('\'')),
     index_along<&Geometry::a_scans>(&ViewState::a_scan, 4), "a_scan", home},
    {Action::zoom_to_tissue, "zoom_to_tissue", "Zoom to tissue", toggle, keys(key('0')),
     Flag{&ViewState::zoom_to_tissue, "on", "off"}, "zoom_to_tissue", home | kept},
    {Action::calliper, "calliper", "Calliper", toggle, keys(key('5')),
     Flag{&ViewState::calliper, "shown", "hidden"}, "calliper", home},
    {Action::mark_1_across, "mark_1_across", "Mark 1, across", continuous, keys(key('6')),
     index_along<&Geometry::a_scans>(&ViewState::mark_1_a, 1), "mark_1_a", home},
    {Action::mark_1_depth, "mark_1_depth", "Mark 1, depth", continuous, keys(key('7')),
     index_along<&Geometry::depths>(&ViewState::mark_1_depth, 1), "mark_1_depth", home},
    {Action::mark_2_across, "mark_2_across", "Mark 2, across", continuous, keys(key('8')),
     index_along<&Geometry::a_scans>(&ViewState::mark_2_a, 1), "mark_2_a", home},
    {Action::mark_2_depth, "mark_2_depth", "Mark 2, depth", continuous, keys(key('9')),
     index_along<&Geometry::depths>(&ViewState::mark_2_depth, 1), "mark_2_depth", home},

    {Action::vessels, "vessels", "Vessels", choice, keys(key('v')),
     one_of<&ViewState::vessels>(vessels_shown_values), "vessels", drawn | home | kept},
    {Action::vessel_opacity, "vessel_opacity", "Vessel opacity", continuous, keys(key('a')),
     Number{.number = &ViewState::vessel_opacity, .range = {0, 1, 0.05F}, .words = percent},
     "vessel_opacity", drawn | kept | needs_vessels},
    {Action::vessel_colours, "vessel_colours", "Vessel colours", choice, keys(key('e')),
     one_of<&ViewState::vessel_colouring>(vessel_colouring_values),
     "vessel_colours", drawn | kept | needs_vessels},
    {Action::vessel_shift_x, "vessel_shift_x", "Shift vessels, x", continuous, keys(key('i')),
     shift_along(0), "vessel_shift_mm", drawn | needs_vessels},
    {Action::vessel_shift_y, "vessel_shift_y", "Shift vessels, y", continuous, keys(key('j')),
     shift_along(1), "vessel_shift_mm", drawn | needs_vessels},
    {Action::vessel_shift_z, "vessel_shift_z", "Shift vessels, z", continuous, keys(key('k')),
     shift_along(2), "vessel_shift_mm", drawn | needs_vessels},
    {Action::vessel_turn_x, "vessel_turn_x", "Turn vessels, x", continuous, keys(key('u')),
     turn_about(0), "vessel_turn_deg", drawn | needs_vessels},
    {Action::vessel_turn_y, "vessel_turn_y", "Turn vessels, y", continuous, keys(key('y')),
     turn_about(1), "vessel_turn_deg", drawn | needs_vessels},
    {Action::vessel_turn_z, "vessel_turn_z", "Turn vessels, z", continuous, keys(key('z')),
     turn_about(2), "vessel_turn_deg", drawn | needs_vessels},
    {Action::vessel_account, "vessel_account", "Vessel account", toggle, keys(key('n')),
     Flag{&ViewState::vessel_account, "shown", "hidden"}, {}, needs_vessels},
    {Action::keep_registration, "keep_registration", "Keep vessels' place", deliberate,
     keys(key('m')), {}, {}, needs_vessels},
    {Action::reset_registration, "reset_registration", "Vessels' place, back", deliberate,
     keys(key('g')), {}, {}, needs_vessels},

    {Action::box, "box", "Box", toggle, keys(key('b')),
     Flag{&ViewState::box_visible, "shown", "hidden"}, "box", home | kept},
    {Action::snapshot, "snapshot", "Snapshot", momentary, keys(key('p')), {}, {}},
    {Action::record, "record", "Recording", momentary, keys(key('r')), {}, {}},
    {Action::figures, "figures", "Engineer's strip", choice, keys(key('`')),
     one_of<&ViewState::figures>(figures_values), "figures"},
    {Action::legend, "legend", "Legend", toggle, keys(key('h'), key(code(Key::f1))),
     Flag{&ViewState::legend_visible, "shown", "hidden"}, "legend"},
}};
// clang-format on

constexpr bool in_the_enumerations_order() {
  for (std::size_t i = 0; i < table.size(); ++i)
    if (index_of(table[i].action) != i)
      return false;
  return true;
}
static_assert(in_the_enumerations_order(), "a row stands where its enumerator does");

constexpr bool each_key_does_one_thing() {
  std::array<bool, 65536> taken{};
  for (const ActionRow& row : table)
    for (const ActionKey& each : row.keys)
      if (each.key != 0 && std::exchange(taken[each.key], true))
        return false;
  return true;
}
static_assert(each_key_does_one_thing(), "a key is bound to two actions");

float within(const Number& number, float value) {
  const NumberRange& range = number.range;
  return number.cyclic ? std::remainder(value, range.highest - range.lowest)
                       : std::clamp(value, range.lowest, range.highest);
}

} // namespace

float Number::of(const ViewState& view) const {
  if (number != nullptr)
    return view.*number;
  return index != nullptr ? static_cast<float>(view.*index) : (view.vessel_nudge.*nudge)[axis];
}

void Number::set(ViewState& view, float value) const {
  const float fitting = within(*this, value);
  if (number != nullptr)
    view.*number = fitting;
  else if (index != nullptr)
    view.*index = static_cast<int>(std::lround(fitting));
  else
    (view.vessel_nudge.*nudge)[axis] = fitting;
}

void Number::fit(ViewState& view, const Geometry& volume) const {
  if (count != nullptr)
    view.*index = std::clamp(view.*index, 0, std::max(volume.*count - 1, 0));
}

std::span<const ActionRow, action_count> action_table() {
  return table;
}

NumberRange range_of(Action action, const Geometry& volume) {
  const Number* number = number_of(action);
  if (number == nullptr)
    return {};
  NumberRange range = number->range;
  if (number->count != nullptr)
    range.highest = static_cast<float>(std::max(volume.*number->count - 1, 1));
  return range;
}

void fit_indices(ViewState& view, const Geometry& volume) {
  for (const ActionRow& row : table)
    if (const auto* number = std::get_if<Number>(&row.value))
      number->fit(view, volume);
}

ActionKind kind_of(Action action) {
  return row_of(action).kind;
}

std::string_view to_string(Action action) {
  return row_of(action).name;
}

std::string_view label_of(Action action) {
  return row_of(action).label;
}

std::optional<Action> action_named(std::string_view name) {
  const auto found = std::ranges::find(table, name, &ActionRow::name);
  return found == table.end() ? std::nullopt : std::optional{found->action};
}

bool moves_mark(Action action) {
  return action >= Action::mark_1_across && action <= Action::mark_2_depth;
}

bool changes_window(Action action) {
  return action == Action::window_offset || action == Action::window_size ||
         action == Action::auto_window;
}

} // namespace octascope::ui
