#include "ui/controls/view_actions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ui/controls/view_text.h"

namespace octascope::ui {

namespace {

constexpr hal::Duration echo_duration = std::chrono::milliseconds{2500};

int wrapped(int value, int count) {
  return ((value % count) + count) % count;
}

} // namespace

ViewActions::ViewActions(const ViewState& initial, const Geometry& volume, std::vector<Action> menu,
                         ChoiceNames names)
    : initial_{initial.clamped()}, state_{initial_}, volume_{volume}, menu_{std::move(menu)} {
  state_.selected = menu_.front();
  set_volume(volume);
  set_choices(std::move(names));
}

void ViewActions::change_menu(std::vector<Action> menu) {
  menu_ = std::move(menu);
  if (std::ranges::find(menu_, state_.selected) == menu_.end())
    state_.selected = menu_.front();
}

void ViewActions::replace(const ViewState& initial, const ViewState& state) {
  initial_ = initial.clamped();
  state_ = state.clamped();
  set_volume(volume_);
}

void ViewActions::set_volume(const Geometry& volume) {
  volume_ = volume;
  fit_indices(state_, volume_);
}

void ViewActions::set_window(float offset_db, float size_db) {
  for (ViewState* view : {&initial_, &state_}) {
    view->window_offset_db = offset_db;
    view->window_size_db = size_db;
    *view = view->clamped();
  }
}

void ViewActions::set_choices(ChoiceNames names) {
  names_ = std::move(names);
  for (const ActionRow& row : action_table())
    if (const auto* choice = std::get_if<NamedChoice>(&row.value))
      for (ViewState* view : {&initial_, &state_})
        view->*choice->index = std::clamp(view->*choice->index, 0,
                                          static_cast<int>((names_.*choice->names).size()) - 1);
}

void ViewActions::tell(Action action, std::string_view words, hal::TimePoint time) {
  state_.echo = {action, false, {}, time + echo_duration};
  state_.echo.words.format("{}", words);
}

void ViewActions::show_window(float offset_db, float size_db, hal::TimePoint time) {
  state_.window_offset_db = offset_db;
  state_.window_size_db = size_db;
  state_ = state_.clamped();
  state_.echo = {Action::auto_window, false, {}, time + echo_duration};
  state_.echo.words.format("{:.0f} to {:.0f} dB", state_.window_offset_db,
                           state_.window_offset_db + state_.window_size_db);
}

void ViewActions::turn(Action action, double detents) {
  const Number* number = number_of(action);
  if (number == nullptr || (vessels_fixed_ && number->nudge != nullptr))
    return;
  double change = detents * static_cast<double>(number->range.detent);
  if (number->index != nullptr) {
    if (std::exchange(rest_of_, action) != action)
      index_rest_ = 0;
    index_rest_ += change;
    change = std::trunc(index_rest_);
    index_rest_ -= change;
  }
  number->set(state_, number->of(state_) + static_cast<float>(change));
  number->fit(state_, volume_);
  state_.calliper = state_.calliper || moves_mark(action);
}

void ViewActions::begin_driving(Action action, hal::TimePoint time) {
  ++counts_[index_of(action)];
  if (action == Action::adjust)
    ++counts_[index_of(state_.selected)];
  drive(action, 0, time);
}

void ViewActions::drive(Action action, double amount, hal::TimePoint time) {
  const Action driven = action == Action::adjust ? state_.selected : action;
  if (number_of(driven) == nullptr)
    return;
  turn(driven, amount);
  tell(driven, "", time);
}

bool ViewActions::moves_vessels(Action action) const {
  const Number* number = number_of(action);
  return (number != nullptr && number->nudge != nullptr) || action == Action::keep_registration ||
         action == Action::reset_registration;
}

// The parallax of a picture that is not in stereo cannot be seen, nor what becomes of vessels that
// are not shown.
bool ViewActions::can_be_selected(Action action) const {
  const ActionRow& row = row_of(action);
  if (row.has(trait::needs_vessels) && !(vessels_loaded_ && shows_tree(state_)))
    return false;
  if (vessels_fixed_ && moves_vessels(action))
    return false;
  return !row.has(trait::needs_stereo) || state_.stereo != StereoMode::off;
}

void ViewActions::select_next(int step, hal::TimePoint time) {
  const int count = static_cast<int>(menu_.size());
  const auto found = std::ranges::find(menu_, state_.selected);
  int place = found == menu_.end() ? 0 : static_cast<int>(found - menu_.begin());
  for (int i = 0; i < std::abs(step); ++i) {
    int tried = 0;
    do
      place = wrapped(place + (step < 0 ? -1 : 1), count);
    while (!can_be_selected(menu_[static_cast<std::size_t>(place)]) && ++tried < count);
  }
  state_.selected = menu_[static_cast<std::size_t>(place)];
  tell(state_.selected, words(state_.selected), time);
  state_.echo.chosen = true;
}

void ViewActions::toggle(Action action, const Flag& value, double amount, Done done,
                         hal::TimePoint time) {
  bool& flag = state_.*value.flag;
  const bool before = flag;
  flag = done == Done::turned ? amount > 0 : !flag;
  if (action == Action::freeze && flag != before)
    state_.frozen_since = flag ? time : hal::TimePoint{};
  tell(action, words(action), time);
}

void ViewActions::choose(Action action, const ActionValue& value, int step, hal::TimePoint time) {
  if (const auto* choice = std::get_if<Choice>(&value)) {
    const int count = static_cast<int>(choice->values.size());
    choice->set(state_, static_cast<std::size_t>(
                            wrapped(static_cast<int>(choice->of(state_)) + step, count)));
  } else if (const auto* named = std::get_if<NamedChoice>(&value)) {
    int& index = state_.*named->index;
    index = wrapped(index + step, static_cast<int>((names_.*named->names).size()));
  }
  tell(action, words(action), time);
}

// Where there is nothing but a tree, it is shown or hidden.
void ViewActions::choose_vessels(double amount, Done done, hal::TimePoint time) {
  if (flow_there_)
    return choose(Action::vessels, row_of(Action::vessels).value,
                  static_cast<int>(std::trunc(amount)), time);
  const bool show = done == Done::turned ? amount > 0 : !shows_tree(state_);
  state_.vessels = show ? VesselsShown::both : VesselsShown::off;
  tell(Action::vessels, words(Action::vessels), time);
}

// Of vessels, what is there of what was chosen.
std::string_view ViewActions::words(Action action) const {
  if (action != Action::vessels || (flow_there_ && vessels_loaded_))
    return words_of(state_, names_, action);
  if (!flow_there_)
    return !vessels_loaded_ ? "none loaded" : shows_tree(state_) ? "shown" : "hidden";
  switch (state_.vessels) {
  case VesselsShown::tree: return "tree: none there";
  case VesselsShown::both: return "flow, no tree there";
  default: return words_of(state_, names_, action);
  }
}

// A frozen picture stays frozen: looking at it afresh must not let it run away. How the glasses
// take their pictures is not a matter of the view, nor where the vessels lie in the volume.
void ViewActions::reset_view() {
  for (const ActionRow& row : action_table())
    if (row.has(trait::home))
      std::visit([&](const auto& value) { value.copy(initial_, state_); }, row.value);
  fit_indices(state_, volume_);
}

void ViewActions::forget_nudge() {
  state_.vessel_nudge = {};
}

// More detents of the same turn find nothing left to do.
ControlRequests ViewActions::move_vessels_for_good(Action action, double amount, Done done,
                                                   hal::TimePoint time) {
  if (!vessels_loaded_) {
    tell(action, "none loaded", time);
    return {};
  }
  if (!state_.vessel_nudge.any() || (done == Done::turned && amount <= 0)) {
    tell(action, words(action), time);
    return {};
  }
  if (action == Action::keep_registration)
    return {.keep_registration = true};
  forget_nudge();
  tell(action, "as it was registered", time);
  return {};
}

ControlRequests ViewActions::adjust(double amount, Done done, hal::TimePoint time) {
  if (done == Done::turned && !takes_detents(kind_of(state_.selected))) {
    tell(state_.selected, "press to do it", time);
    return {};
  }
  return perform(state_.selected, amount, done, time);
}

ControlRequests ViewActions::perform(Action action, double amount, Done done, hal::TimePoint time) {
  ++counts_[index_of(action)];
  if (number_of(action) != nullptr) {
    turn(action, amount);
    tell(action, "", time);
    return {};
  }
  const int step = static_cast<int>(std::trunc(amount));
  switch (action) {
  case Action::adjust: return adjust(amount, done, time);
  case Action::next_parameter: select_next(step, time); return {};
  case Action::previous_parameter: select_next(-step, time); return {};
  case Action::auto_window: return {.auto_window = true};
  case Action::snapshot: return {.snapshot = true};
  case Action::record: return {.record = true};
  case Action::keep_registration:
  case Action::reset_registration: return move_vessels_for_good(action, amount, done, time);
  case Action::vessels: choose_vessels(amount, done, time); return {};
  case Action::reset_view:
    reset_view();
    tell(action, "restored", time);
    return {};
  default: break;
  }
  const ActionValue& value = row_of(action).value;
  if (const auto* flag = std::get_if<Flag>(&value))
    toggle(action, *flag, amount, done, time);
  else
    choose(action, value, step, time);
  return {};
}

} // namespace octascope::ui
