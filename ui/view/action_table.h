// One row per action: its names, its keys, and what it changes in the view, with range and words.
//
// Help, legend, key bindings, report and settings are made from these rows. To add an action, add
// its enumerator (action.h) and its row; if it does more than change the view's value, implement
// that in ViewActions (ui/controls/view_actions.h).
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

#include "ui/view/action.h"
#include "ui/view/choice_value.h"
#include "ui/view/fixed_text.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

using ValueText = FixedText<48>;

// A key of the keyboard; 0: none.
struct ActionKey {
  std::uint16_t key = 0; // hal::DisplayEvent::key
  int step = 0;          // −1 or 1; 0: shift decides
};
inline constexpr std::size_t most_keys = 5;

// What an action changes in the view. Each kind of value can copy itself between views and compare
// itself in two views.

struct NoValue {
  static void copy(const ViewState&, ViewState&) {}
  static bool same(const ViewState&, const ViewState&) { return true; }
};

inline constexpr float last_b_scan = std::numeric_limits<float>::infinity();

struct NumberRange {
  float lowest;
  float highest; // last_b_scan: the index of the last B-scan
  float detent;  // change per click of the knob
};

// Exactly one of the three pointers is set.
struct Number {
  float ViewState::*number = nullptr;
  int ViewState::*index = nullptr;
  std::array<float, 3> VesselNudge::*nudge = nullptr;
  std::size_t axis = 0; // of nudge
  NumberRange range{};
  ValueText (*words)(float value) = nullptr; // "36 dB"
  bool cyclic = false;                       // the highest value equals the lowest

  float of(const ViewState& view) const;
  void set(ViewState& view, float value) const; // clamps to the range
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

// One of an enumeration.
struct Choice {
  std::size_t (*of)(const ViewState& view);
  void (*set)(ViewState& view, std::size_t value);
  std::span<const ChoiceValue> values;

  void copy(const ViewState& from, ViewState& to) const { set(to, of(from)); }
  bool same(const ViewState& a, const ViewState& b) const { return of(a) == of(b); }
};

// One of a list that the configuration defines.
struct NamedChoice {
  int ViewState::*index;
  std::vector<std::string> ChoiceNames::*names;

  void copy(const ViewState& from, ViewState& to) const { to.*index = from.*index; }
  bool same(const ViewState& a, const ViewState& b) const { return a.*index == b.*index; }
};

using ActionValue = std::variant<NoValue, Number, Flag, Choice, NamedChoice>;

// Properties of an action, or'ed.
namespace trait {
inline constexpr unsigned drawn = 1;          // its value changes the volume's picture
inline constexpr unsigned home = 2;           // reset_view resets its value
inline constexpr unsigned kept = 4;           // its value is a setting, which outlives a run
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
  std::string_view key; // of the value in reports and settings; empty: in neither
  unsigned traits = 0;

  bool has(unsigned trait) const { return (traits & trait) != 0; }
};

// In the order of the enumeration.
std::span<const ActionRow, action_count> action_table();

inline const ActionRow& row_of(Action action) {
  return action_table()[index_of(action)];
}

// The number that an action turns; null for all other actions.
inline const Number* number_of(Action action) {
  return std::get_if<Number>(&row_of(action).value);
}

// With numbers for both ends; empty for an action without a number.
NumberRange range_of(Action action, int b_scans = 1);

// For std::visit.
template <class... Functions> struct Overloaded : Functions... { using Functions::operator()...; };
template <class... Functions> Overloaded(Functions...) -> Overloaded<Functions...>;

} // namespace octascope::ui
