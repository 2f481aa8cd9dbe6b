#include "ui/controls/view_actions.h"

#include <algorithm>
#include <cmath>

#include "ui/controls/view_text.h"

namespace octascope::ui {

namespace {

constexpr hal::Duration echo_duration = std::chrono::milliseconds{2500};

int wrapped(int value, int count) {
  return ((value % count) + count) % count;
}

template <class Enum> Enum stepped(Enum value, int step, int count) {
  return static_cast<Enum>(wrapped(static_cast<int>(value) + step, count));
}

} // namespace

ViewActions::ViewActions(const ViewState& initial, int b_scans, std::vector<Action> menu)
    : initial_{initial.clamped()}, state_{initial_}, b_scans_{b_scans}, menu_{std::move(menu)} {
  state_.selected = menu_.front();
  set_b_scans(b_scans);
  set_choices({});
}

void ViewActions::change_menu(std::vector<Action> menu) {
  menu_ = std::move(menu);
  if (std::ranges::find(menu_, state_.selected) == menu_.end())
    state_.selected = menu_.front();
}

void ViewActions::replace(const ViewState& initial, const ViewState& state) {
  initial_ = initial.clamped();
  state_ = state.clamped();
  set_b_scans(b_scans_);
}

void ViewActions::set_b_scans(int b_scans) {
  b_scans_ = std::max(b_scans, 1);
  state_.b_scan = std::min(state_.b_scan, b_scans_ - 1);
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
  for (ViewState* view : {&initial_, &state_}) {
    view->transfer = std::clamp(view->transfer, 0, static_cast<int>(names_.transfers.size()) - 1);
    view->colour_map = std::clamp(view->colour_map, 0, static_cast<int>(names_.colours.size()) - 1);
  }
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

void ViewActions::turn(Parameter parameter, double detents) {
  if (parameter == Parameter::b_scan) {
    b_scan_rest_ += detents;
    detents = std::trunc(b_scan_rest_);
    b_scan_rest_ -= detents;
  }
  const ParameterRange range = parameter_range(parameter, b_scans_);
  set_parameter(state_, parameter,
                parameter_value(state_, parameter) + static_cast<float>(detents) * range.detent);
  state_ = state_.clamped();
  state_.b_scan = std::min(state_.b_scan, b_scans_ - 1);
}

void ViewActions::begin_driving(Action action, hal::TimePoint time) {
  ++counts_[index_of(action)];
  if (action == Action::adjust)
    ++counts_[index_of(state_.selected)];
  drive(action, 0, time);
}

void ViewActions::drive(Action action, double amount, hal::TimePoint time) {
  const Action driven = action == Action::adjust ? state_.selected : action;
  const auto parameter = parameter_of(driven);
  if (!parameter)
    return;
  turn(*parameter, amount);
  tell(driven, "", time);
}

// The parallax of a picture that is not in stereo cannot be seen, nor what becomes of vessels that
// are not shown.
bool ViewActions::can_be_selected(Action action) const {
  if (action > Action::vessels && action <= Action::reset_registration)
    return vessels_loaded_ && state_.vessels_visible;
  return action != Action::parallax || state_.stereo != StereoMode::off;
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
  tell(state_.selected, words_of(state_, names_, state_.selected), time);
  state_.echo.chosen = true;
}

void ViewActions::toggle(Action action, double amount, Done done, hal::TimePoint time) {
  const auto change = [&](bool& flag) { flag = done == Done::turned ? amount > 0 : !flag; };
  switch (action) {
  case Action::freeze: {
    const bool before = state_.frozen;
    change(state_.frozen);
    if (state_.frozen != before)
      state_.frozen_since = state_.frozen ? time : hal::TimePoint{};
    break;
  }
  case Action::vessels: change(state_.vessels_visible); break;
  case Action::vessel_account: change(state_.vessel_account); break;
  case Action::box: change(state_.box_visible); break;
  case Action::legend: change(state_.legend_visible); break;
  default: break;
  }
  if (action == Action::vessels && !vessels_loaded_)
    tell(action, "none loaded", time);
  else
    tell(action, words_of(state_, names_, action), time);
}

void ViewActions::choose(Action action, int step, hal::TimePoint time) {
  switch (action) {
  case Action::technique:
    state_.technique = stepped(state_.technique, step, static_cast<int>(all_techniques.size()));
    break;
  case Action::transfer:
    state_.transfer = wrapped(state_.transfer + step, static_cast<int>(names_.transfers.size()));
    break;
  case Action::colours:
    state_.colour_map = wrapped(state_.colour_map + step, static_cast<int>(names_.colours.size()));
    break;
  case Action::layout: state_.layout = stepped(state_.layout, step, layout_count); break;
  case Action::vessel_colours:
    state_.vessel_colouring = stepped(state_.vessel_colouring, step, vessel_colouring_count);
    break;
  case Action::stereo: state_.stereo = stepped(state_.stereo, step, stereo_count); break;
  default: break;
  }
  tell(action, words_of(state_, names_, action), time);
}

// A frozen picture stays frozen: looking at it afresh must not let it run away. How the glasses
// take their pictures is not a matter of the view, nor where the vessels lie in the volume.
void ViewActions::reset_view() {
  const ViewState old = state_;
  state_ = initial_;
  state_.frozen = old.frozen;
  state_.frozen_since = old.frozen_since;
  state_.stereo = old.stereo;
  state_.parallax_deg = old.parallax_deg;
  state_.vessel_opacity = old.vessel_opacity;
  state_.vessel_colouring = old.vessel_colouring;
  state_.vessel_nudge = old.vessel_nudge;
  state_.vessel_account = old.vessel_account;
  state_.legend_visible = old.legend_visible;
  state_.legend_of_keys = old.legend_of_keys;
  state_.selected = old.selected;
  state_.b_scan = std::min(state_.b_scan, b_scans_ - 1);
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
    tell(action, words_of(state_, names_, action), time);
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
  if (const auto parameter = parameter_of(action)) {
    turn(*parameter, amount);
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
  case Action::reset_view:
    reset_view();
    tell(action, "restored", time);
    return {};
  default: break;
  }
  if (kind_of(action) == ActionKind::toggle)
    toggle(action, amount, done, time);
  else
    choose(action, step, time);
  return {};
}

} // namespace octascope::ui
