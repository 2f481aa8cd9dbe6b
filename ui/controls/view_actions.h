// What each action does to the view.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "ui/view/action_table.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Requests of an event to the host, beyond the new view.
struct ControlRequests {
  bool quit = false;
  bool snapshot = false;
  bool auto_window = false; // fit the window to the shown volume
  bool record = false;
  bool keep_registration = false; // with the view's nudge
  bool operator==(const ControlRequests&) const = default;

  void add(const ControlRequests& more) {
    quit = quit || more.quit;
    snapshot = snapshot || more.snapshot;
    auto_window = auto_window || more.auto_window;
    record = record || more.record;
    keep_registration = keep_registration || more.keep_registration;
  }
};

enum class Done : std::uint8_t { pressed, turned };

// Threads: one at a time. Pure: no clock.
class ViewActions {
public:
  // `initial` is the state that reset_view restores; `volume` limits positions in it; `menu`
  // is what next_parameter goes through, never empty; `names` are of what the view's transfer
  // function and colour map are chosen from.
  ViewActions(const ViewState& initial, const Geometry& volume, std::vector<Action> menu,
              ChoiceNames names = {});

  // Keeps the selected action if the new menu has it, else selects the menu's first.
  void change_menu(std::vector<Action> menu);

  const ViewState& state() const { return state_; }

  // How often each action was done, by index_of(). What `adjust` did counts for both actions.
  const std::array<std::uint64_t, action_count>& counts() const { return counts_; }

  // The state that reset_view restores.
  const ViewState& initial() const { return initial_; }
  // Replaces both states, with every value clamped to its range: after restoring settings or
  // reloading the configuration.
  void replace(const ViewState& initial, const ViewState& state);

  void set_volume(const Geometry& volume);
  void set_window(float offset_db, float size_db); // also for reset_view
  void set_choices(ChoiceNames names);
  void set_vessels_loaded(bool loaded) { vessels_loaded_ = loaded; }
  // Whether volumes have flow: without, vessels are shown or hidden and nothing else.
  void set_flow_there(bool there) { flow_there_ = there; }
  // They were traced in this very volume: nothing moves them.
  void set_vessels_traced() {
    vessels_loaded_ = vessels_fixed_ = true;
    forget_nudge();
  }

  // The vessels' current placement was saved as their registration: the nudge restarts from zero.
  void forget_nudge();

  // Does the action once. `amount`: detents for a continuous action, else steps, rounded towards 0.
  // Turning a toggle right switches it on, left off.
  ControlRequests perform(Action action, double amount, Done done, hal::TimePoint time);

  // While a stick is pushed: begin_driving() counts the action once, then drive() changes its value
  // a little each frame.
  void begin_driving(Action action, hal::TimePoint time);
  void drive(Action action, double amount, hal::TimePoint time);

  // Whether the legend shows the keys instead of the pedal.
  void show_keys_in_legend(bool keys) { state_.legend_of_keys = keys; }

  // Shows on the display the result of an action that the host did.
  void tell(Action action, std::string_view words, hal::TimePoint time);
  // Sets the window that the host found, and shows it.
  void show_window(float offset_db, float size_db, hal::TimePoint time);

private:
  void turn(Action action, double detents);
  void select_next(int step, hal::TimePoint time);
  void toggle(Action action, const Flag& value, double amount, Done done, hal::TimePoint time);
  void choose(Action action, const ActionValue& value, int step, hal::TimePoint time);
  void choose_vessels(double amount, Done done, hal::TimePoint time);
  std::string_view words(Action action) const;
  void reset_view();
  bool can_be_selected(Action action) const;
  bool moves_vessels(Action action) const;
  ControlRequests move_vessels_for_good(Action action, double amount, Done done,
                                        hal::TimePoint time);
  ControlRequests adjust(double amount, Done done, hal::TimePoint time);

  ViewState initial_;
  ViewState state_;
  Geometry volume_;
  Action rest_of_ = Action::b_scan; // the index turned last, and
  double index_rest_ = 0;           // the fraction of a voxel turned so far
  std::vector<Action> menu_;
  ChoiceNames names_;
  bool vessels_loaded_ = false;
  bool flow_there_ = false;
  bool vessels_fixed_ = false;
  std::array<std::uint64_t, action_count> counts_{};
};

} // namespace octascope::ui
