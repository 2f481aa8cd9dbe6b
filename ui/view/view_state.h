// The surgeon's choices: view direction, display window, what is shown.
//
// A plain value with one writer, the render thread: ViewActions changes it at the start of a frame,
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

// The arrangement of the display.
enum class LayoutKind : std::uint8_t {
  volume,     // large 3D view, the other pictures in a column
  b_scan,     // large B-scan, the others small
  microscope, // large microscope picture with the volume inset
  quad,       // all four alike
};

// For displays that show one picture to each eye.
enum class StereoMode : std::uint8_t { off, side_by_side, top_bottom };

// Where the volume is cut open.
enum class CutShape : std::uint8_t {
  none,
  b_scan, // at `b_scan`
  corner, // at `b_scan` and `a_scan`: the corner between them is left out
};

// Which vessels are shown, of those there are: what flows, found in the signal, and the tree.
enum class VesselsShown : std::uint8_t { off, flow, tree, both };

// What is shown of the machine itself.
enum class FiguresShown : std::uint8_t {
  none,
  strip,  // the engineer's strip
  timing, // and the timing diagram above it
};

// What a control just did, to be shown on the display.
struct Echo {
  Action action = Action::window_offset;
  bool chosen = false;    // the knob has just been assigned to it
  FixedText<48> words;    // the result; empty for a number, which the display formats itself
  hal::TimePoint until{}; // end of display

  bool operator==(const Echo&) const = default;
};

struct ViewState {
  // The camera always faces the centre of the volume. Yaw turns about the depth axis; tilt raises
  // the eye: tilt 0 looks along the surface, 90 straight down onto it (en face).
  float yaw_deg = 35;
  float tilt_deg = 35;
  float distance = 3.1F; // from the centre, in half-diagonals of the volume's box

  // Display window in decibels, formula (1) of the OCT paper: opacity is 0 below `offset` and rises
  // to 1 over `size`; grey equals opacity.
  float window_offset_db = 8;
  float window_size_db = 36;

  Technique technique = Technique::rays;
  int transfer = 0;              // index of the transfer function; 0 is the window itself
  int colour_map = 0;            // index of the colour map; 0 is grey
  float opacity = 0.5F;          // of a voxel at the top of the window, per reference step
  float see_through_db = 12;     // by which tissue that covers other tissue is drawn weaker
  CutShape cut = CutShape::none; // ui/view/cut.h
  bool box_visible = true;       // the wire-frame box
  bool frozen = false;           // the volume stays; the view can still move
  hal::TimePoint frozen_since{}; // when `frozen` became true
  bool rolling = false;          // each B-scan is shown as it comes; else whole volumes
  LayoutKind layout = LayoutKind::volume;
  StereoMode stereo = StereoMode::off;
  float parallax_deg = 3; // between the two eyes, seen from the centre of the volume
  VesselsShown vessels = VesselsShown::both;
  float vessel_opacity = 1;
  VesselColouring vessel_colouring = VesselColouring::branch;
  VesselNudge vessel_nudge;    // relative to the registration
  bool vessel_account = false; // shows the segment counts
  FiguresShown figures = FiguresShown::none;
  bool legend_visible = false; // what each control does
  bool legend_of_keys = false; // shows the keys instead
  int b_scan = 40;             // index of the panel's B-scan on the slow axis
  int a_scan = 150;            // index on the fast axis, where the crossed B-scan lies
  bool zoom_to_tissue = true;  // the flat pictures leave out what is empty
  bool calliper = false;       // two marks in the B-scan and how far they are apart
  int mark_1_a = 100;          // indices of the voxels that they lie in
  int mark_1_depth = 170;
  int mark_2_a = 200;
  int mark_2_depth = 170;

  Action selected = Action::window_offset; // what the knob controls
  Echo echo;

  ViewState clamped() const; // with every value in its range (action_table.h)

  bool operator==(const ViewState&) const = default;
};

// Of a volume that has it.
inline bool shows_flow(const ViewState& view) {
  return view.vessels == VesselsShown::flow || view.vessels == VesselsShown::both;
}
// Of a tree that is loaded.
inline bool shows_tree(const ViewState& view) {
  return view.vessels == VesselsShown::tree || view.vessels == VesselsShown::both;
}

// Whether the volume's picture is the same for both: same eye position, window, technique, layout,
// vessels and so on (trait::drawn in action_table.h).
bool same_sight(const ViewState& a, const ViewState& b);

} // namespace octascope::ui
