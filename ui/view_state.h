// What the surgeon has chosen: where to look from, what window, what to show.
//
// Immutable once shared: every change makes a new one, so the renderer always sees a whole state.
#pragma once

namespace octascope::ui {

struct ViewState {
  // The camera always faces the centre of the volume. Yaw turns about the depth axis, tilt raises
  // the eye; tilt 0 looks along the surface, 90 straight down onto it (en face).
  float yaw_deg = 35;
  float tilt_deg = 30;
  float distance = 2.4F; // from the centre, in half-diagonals of the volume's box

  // Display window in decibels, the paper's formula (1): opacity is 0 below `offset`, rises to 1
  // over `size`, and grey equals opacity.
  float window_offset_db = 8;
  float window_size_db = 36;

  int planes = 192;          // of the view-aligned plane stack
  float opacity = 1.0F;      // of a voxel at the top of the window, per reference step
  bool box_visible = true;   // the wire-frame box
  bool frozen = false;       // the volume stays, the view still moves
  int b_scan = 40;           // position of the B-scan panel, an index on the slow axis

  ViewState clamped() const; // every value brought into its range

  bool operator==(const ViewState&) const = default;
};

} // namespace octascope::ui
