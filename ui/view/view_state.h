// What the surgeon has chosen: where to look from, what window, what to show.
//
// Immutable once shared: every change makes a new one, so the renderer always sees a whole state.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"
#include "ui/view/action.h"
#include "ui/view/fixed_text.h"
#include "ui/view/technique.h"
#include "ui/view/vessel_placement.h"
#include "ui/view/vessel_look.h"

namespace octascope::ui {

// What a knob can turn.
enum class Parameter : std::uint8_t {
  window_offset,
  window_size,
  yaw,
  tilt,
  distance,
  b_scan,
  parallax,
  vessel_opacity,
  vessel_shift_x,
  vessel_shift_y,
  vessel_shift_z,
  vessel_turn_x,
  vessel_turn_y,
  vessel_turn_z,
};
inline constexpr int parameter_count = 14;

// How the display is divided.
enum class LayoutKind : std::uint8_t {
  volume,     // large 3D view, the other pictures in a column
  b_scan,     // large B-scan, the others small
  microscope, // large microscope picture with the volume inset
  quad,       // all four alike
};
inline constexpr int layout_count = 4;

// For displays that show one picture to each eye.
enum class StereoMode : std::uint8_t { off, side_by_side, top_bottom };
inline constexpr int stereo_count = 3;

// What a control just did, for the display to say.
struct Echo {
  Action action = Action::window_offset;
  bool chosen = false;    // the knob turns it from now on
  FixedText<48> words;    // what became of it; empty for a parameter, whose value says it
  hal::TimePoint until{}; // shown until then

  bool operator==(const Echo&) const = default;
};

struct ViewState {
  // The camera always faces the centre of the volume. Yaw turns about the depth axis, tilt raises
  // the eye; tilt 0 looks along the surface, 90 straight down onto it (en face).
  float yaw_deg = 35;
  float tilt_deg = 35;
  float distance = 3.1F; // from the centre, in half-diagonals of the volume's box

  // Display window in decibels, the paper's formula (1): opacity is 0 below `offset`, rises to 1
  // over `size`, and grey equals opacity.
  float window_offset_db = 8;
  float window_size_db = 36;

  Technique technique = Technique::rays;
  int transfer = 0;              // which of the loaded transfer functions; 0 is the window itself
  int colour_map = 0;            // which of the colour maps; 0 is grey
  float opacity = 0.5F;          // of a voxel at the top of the window, per reference step
  bool box_visible = true;       // the wire-frame box
  bool frozen = false;           // the volume stays, the view still moves
  hal::TimePoint frozen_since{}; // when `frozen` became true
  LayoutKind layout = LayoutKind::volume;
  StereoMode stereo = StereoMode::off;
  float parallax_deg = 3;      // between the two eyes, seen from the centre of the volume
  bool vessels_visible = true; // the vessel tree, where one is loaded
  float vessel_opacity = 1;
  VesselColouring vessel_colouring = VesselColouring::branch;
  VesselNudge vessel_nudge;    // since it was registered
  bool vessel_account = false; // how many of its segments were drawn, and how
  bool legend_visible = false; // what each control does
  bool legend_of_keys = false; // what each key does, in its place
  int b_scan = 40;             // position of the B-scan panel, an index on the slow axis

  Action selected = Action::window_offset; // what the knob turns
  Echo echo;

  ViewState clamped() const; // every value brought into its range

  bool operator==(const ViewState&) const = default;
};

// Whether both show the volume from the same place in the same way: what a knob's turn changes of
// its picture.
bool same_sight(const ViewState& a, const ViewState& b);

struct ParameterRange {
  float lowest;
  float highest;
  float detent; // what one click of the knob changes
};

// The ranges of clamped(); the last B-scan is b_scans − 1.
ParameterRange parameter_range(Parameter parameter, int b_scans);
float parameter_value(const ViewState& view, Parameter parameter);
void set_parameter(ViewState& view, Parameter parameter, float value);

// The parameter that an action turns; empty for all others.
std::optional<Parameter> parameter_of(Action action);

} // namespace octascope::ui
