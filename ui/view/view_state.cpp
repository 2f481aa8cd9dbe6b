#include "ui/view/view_state.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace octascope::ui {

ViewState ViewState::clamped() const {
  const auto within = [](float value, Parameter parameter) {
    const ParameterRange range = parameter_range(parameter, 1);
    return std::clamp(value, range.lowest, range.highest);
  };
  ViewState v = *this;
  v.yaw_deg = std::remainder(v.yaw_deg, 360.0F);
  v.tilt_deg = within(v.tilt_deg, Parameter::tilt);
  v.distance = within(v.distance, Parameter::distance);
  v.window_offset_db = within(v.window_offset_db, Parameter::window_offset);
  v.window_size_db = within(v.window_size_db, Parameter::window_size);
  v.vessel_opacity = within(v.vessel_opacity, Parameter::vessel_opacity);
  for (float& shift : v.vessel_nudge.shift_mm)
    shift = within(shift, Parameter::vessel_shift_x);
  for (float& turn : v.vessel_nudge.turn_deg)
    turn = std::remainder(turn, 360.0F);
  v.parallax_deg = within(v.parallax_deg, Parameter::parallax);
  v.opacity = std::clamp(v.opacity, 0.01F, 1.0F);
  v.b_scan = std::max(v.b_scan, 0);
  return v;
}

bool same_sight(const ViewState& a, const ViewState& b) {
  const auto sight = [](const ViewState& v) {
    return std::tie(v.yaw_deg, v.tilt_deg, v.distance, v.window_offset_db, v.window_size_db,
                    v.opacity, v.technique, v.transfer, v.colour_map, v.layout, v.stereo,
                    v.parallax_deg, v.vessels_visible, v.vessel_opacity, v.vessel_colouring,
                    v.vessel_nudge.shift_mm, v.vessel_nudge.turn_deg);
  };
  return sight(a) == sight(b);
}

ParameterRange parameter_range(Parameter parameter, int b_scans) {
  switch (parameter) {
  case Parameter::window_offset: return {-40, 87, 1};
  case Parameter::window_size: return {1, 128, 1};
  case Parameter::yaw: return {-180, 180, 3};
  case Parameter::tilt: return {-89, 89, 3};
  case Parameter::distance: return {0.6F, 8, 0.05F};
  case Parameter::b_scan: return {0, static_cast<float>(std::max(b_scans - 1, 1)), 1};
  case Parameter::parallax: return {-10, 10, 0.25F};
  case Parameter::vessel_opacity: return {0, 1, 0.05F};
  case Parameter::vessel_shift_x:
  case Parameter::vessel_shift_y:
  case Parameter::vessel_shift_z: return {-50, 50, 0.02F};
  case Parameter::vessel_turn_x:
  case Parameter::vessel_turn_y:
  case Parameter::vessel_turn_z: return {-180, 180, 0.5F};
  }
  return {0, 1, 1};
}

float parameter_value(const ViewState& view, Parameter parameter) {
  switch (parameter) {
  case Parameter::window_offset: return view.window_offset_db;
  case Parameter::window_size: return view.window_size_db;
  case Parameter::yaw: return view.yaw_deg;
  case Parameter::tilt: return view.tilt_deg;
  case Parameter::distance: return view.distance;
  case Parameter::b_scan: return static_cast<float>(view.b_scan);
  case Parameter::parallax: return view.parallax_deg;
  case Parameter::vessel_opacity: return view.vessel_opacity;
  case Parameter::vessel_shift_x: return view.vessel_nudge.shift_mm[0];
  case Parameter::vessel_shift_y: return view.vessel_nudge.shift_mm[1];
  case Parameter::vessel_shift_z: return view.vessel_nudge.shift_mm[2];
  case Parameter::vessel_turn_x: return view.vessel_nudge.turn_deg[0];
  case Parameter::vessel_turn_y: return view.vessel_nudge.turn_deg[1];
  case Parameter::vessel_turn_z: return view.vessel_nudge.turn_deg[2];
  }
  return 0;
}

void set_parameter(ViewState& view, Parameter parameter, float value) {
  switch (parameter) {
  case Parameter::window_offset: view.window_offset_db = value; break;
  case Parameter::window_size: view.window_size_db = value; break;
  case Parameter::yaw: view.yaw_deg = value; break;
  case Parameter::tilt: view.tilt_deg = value; break;
  case Parameter::distance: view.distance = value; break;
  case Parameter::b_scan: view.b_scan = static_cast<int>(std::lround(value)); break;
  case Parameter::parallax: view.parallax_deg = value; break;
  case Parameter::vessel_opacity: view.vessel_opacity = value; break;
  case Parameter::vessel_shift_x: view.vessel_nudge.shift_mm[0] = value; break;
  case Parameter::vessel_shift_y: view.vessel_nudge.shift_mm[1] = value; break;
  case Parameter::vessel_shift_z: view.vessel_nudge.shift_mm[2] = value; break;
  case Parameter::vessel_turn_x: view.vessel_nudge.turn_deg[0] = value; break;
  case Parameter::vessel_turn_y: view.vessel_nudge.turn_deg[1] = value; break;
  case Parameter::vessel_turn_z: view.vessel_nudge.turn_deg[2] = value; break;
  }
}

std::optional<Parameter> parameter_of(Action action) {
  switch (action) {
  case Action::window_offset: return Parameter::window_offset;
  case Action::window_size: return Parameter::window_size;
  case Action::rotate: return Parameter::yaw;
  case Action::tilt: return Parameter::tilt;
  case Action::distance: return Parameter::distance;
  case Action::b_scan: return Parameter::b_scan;
  case Action::parallax: return Parameter::parallax;
  case Action::vessel_opacity: return Parameter::vessel_opacity;
  case Action::vessel_shift_x: return Parameter::vessel_shift_x;
  case Action::vessel_shift_y: return Parameter::vessel_shift_y;
  case Action::vessel_shift_z: return Parameter::vessel_shift_z;
  case Action::vessel_turn_x: return Parameter::vessel_turn_x;
  case Action::vessel_turn_y: return Parameter::vessel_turn_y;
  case Action::vessel_turn_z: return Parameter::vessel_turn_z;
  default: return std::nullopt;
  }
}

} // namespace octascope::ui
