// What the surgeon has chosen: the direction of view, the display window, what is shown.
//
// A plain value with one writer, the render thread: ViewActions changes it at the head of a frame,
// and the frame is drawn from it.
#pragma once

#include <cstdint>

#include "hal/clock.h"
#include "ui/view/action.h"
#include "ui/view/fixed_text.h"
#include "ui/view/technique.h"
#include "ui/view/vessel_look.h"
#include "ui/view/vessel_placement.h"

namespace octascope::ui {

// How the display is divided.
enum class LayoutKind : std::uint8_t {
  volume,     // large 3D view, the other pictures in a column
  b_scan,     // large B-scan, the others small
  microscope, // large microscope picture with the volume inset
  quad,       // all four alike
};

// For displays that show one picture to each eye.
enum class StereoMode : std::uint8_t { off, side_by_side, top_bottom };

// What a control just did, for the display to say.
struct Echo {
  Action action = Action::window_offset;
  bool chosen = false;    // the knob turns it from now on
  FixedText<48> words;    // the result; empty for a number, which the display formats itself
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
  bool vessels_visible = true; // the vessel tree, if one is loaded
  float vessel_opacity = 1;
  VesselColouring vessel_colouring = VesselColouring::branch;
  VesselNudge vessel_nudge;    // since it was registered
  bool vessel_account = false; // how many of its segments were drawn, and how
  bool legend_visible = false; // what each control does
  bool legend_of_keys = false; // what each key does, in its place
  int b_scan = 40;             // position of the B-scan panel, an index on the slow axis

  Action selected = Action::window_offset; // what the knob turns
  Echo echo;

  ViewState clamped() const; // every value brought into its range (action_table.h)

  bool operator==(const ViewState&) const = default;
};

// Whether the volume's picture is the same in both: same camera, window, technique, layout, vessels
// and so on (trait::drawn in action_table.h).
bool same_sight(const ViewState& a, const ViewState& b);

} // namespace octascope::ui
