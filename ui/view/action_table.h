// One row per action: names, keys, and the view value that it changes, with range and text.
//
// Help, legend, key bindings, report and settings are generated from these rows. To add an action,
// add its enumerator (action.h) and its row; if it does more than change the view's value,
// implement that in ViewActions (ui/controls/view_actions.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pipeline/volume/volume_geometry.h"
#include "ui/view/action.h"
#include "ui/view/choice_value.h"
#include "ui/view/fixed_text.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

using Geometry = pipeline::VolumeGeometry;
using ValueText = FixedText<48>;

// A key of the keyboard.
struct ActionKey {
  std::uint16_t key = 0; // hal::DisplayEvent::key; 0: none
  int step = 0;          // −1 or 1; 0: depends on shift
};
inline constexpr std::size_t most_keys = 5;

// What an action changes in the view. Each kind of value can be copied from one view to another and
// compared between two views.

struct NoValue {
  static void copy(const ViewState&, ViewState&) {}
  static bool same(const ViewState&, const ViewState&) { return true; }
};

inline constexpr float last_index = std::numeric_limits<float>::infinity();

struct NumberRange {
  float lowest;
  float highest; // last_index: the last voxel along its axis
  float detent;  // change per knob detent
};

// Exactly one of the three pointers is set.
struct Number {
  float ViewState::*number = nullptr;
  int ViewState::*index = nullptr;
  std::array<float, 3> VesselNudge::*nudge = nullptr;
  std::size_t axis = 0;           // of the nudge
  int Geometry::*count = nullptr; // of the axis whose voxels the index counts
  NumberRange range{};
  ValueText (*words)(float value) = nullptr; // "36 dB"
  bool cyclic = false;                       // wraps around: highest equals lowest

  float of(const ViewState& view) const;
  void set(ViewState& view, float value) const;            // clamps to the range
  void fit(ViewState& view, const Geometry& volume) const; // an index into the volume
  void copy(const ViewState& from, ViewState& to) const { set(to, of(from)); }
  bool same(const ViewState& a, const ViewState& b) const { return of(a) == of(b); }
};

struct Flag {
  bool ViewState::*flag;
  std::string_view on;
  std::string_view off;

  void copy(const ViewState& from, ViewState& to) const { to.*flag = from.*flag; }
  bool same(const ViewState& a, const ViewState& b) const { return a.*flag == b.*flag; }
};

// A value of an enumeration.
struct Choice {
  std::size_t (*of)(const ViewState& view);
  void (*set)(ViewState& view, std::size_t value);
  std::span<const ChoiceValue> values;

  void copy(const ViewState& from, ViewState& to) const { set(to, of(from)); }
  bool same(const ViewState& a, const ViewState& b) const { return of(a) == of(b); }
};

// One of the entries named in the configuration.
struct NamedChoice {
  int ViewState::*index;
  std::vector<std::string> ChoiceNames::*names;

  void copy(const ViewState& from, ViewState& to) const { to.*index = from.*index; }
  bool same(const ViewState& a, const ViewState& b) const { return a.*index == b.*index; }
};

using ActionValue = std::variant<NoValue, Number, Flag, Choice, NamedChoice>;

// Properties of an action, combined with |.
namespace trait {
inline constexpr unsigned drawn = 1;          // its value changes the volume's picture
inline constexpr unsigned home = 2;           // reset_view resets its value
inline constexpr unsigned kept = 4;           // its value is a setting, saved between runs
inline constexpr unsigned needs_stereo = 8;   // next_parameter skips it unless in stereo
inline constexpr unsigned needs_vessels = 16; // next_parameter skips it unless vessels are shown
} // namespace trait

struct ActionRow {
  Action action;
  std::string_view name;  // in profiles and reports
  std::string_view label; // on the display
  ActionKind kind;
  std::array<ActionKey, most_keys> keys;
  ActionValue value;
  std::string_view key; // of the value in reports and settings; empty: not in them
  unsigned traits = 0;

  bool has(unsigned trait) const { return (traits & trait) != 0; }
};

// In the order of the enumeration.
std::span<const ActionRow, action_count> action_table();

inline const ActionRow& row_of(Action action) {
  return action_table()[index_of(action)];
}

// The number that an action changes; null for all other actions.
inline const Number* number_of(Action action) {
  return std::get_if<Number>(&row_of(action).value);
}

// With resolved ends; empty for actions that change no number.
NumberRange range_of(Action action, const Geometry& volume = {});

// Every index within that volume.
void fit_indices(ViewState& view, const Geometry& volume);

// For std::visit.
template <class... Functions> struct Overloaded : Functions... { using Functions::operator()...; };
template <class... Functions> Overloaded(Functions...) -> Overloaded<Functions...>;

} // namespace octascope::ui
