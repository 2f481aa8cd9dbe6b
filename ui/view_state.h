// What the surgeon has chosen: where to look from, what window, what to show.
//
// Immutable once shared: every change makes a new one, so the renderer always sees a whole state.
#pragma once

#include <cstdint>

#include "hal/clock.h"

namespace octascope::ui {

// What a knob can turn.
enum class Parameter : std::uint8_t { window_offset, window_size, yaw, tilt, distance, b_scan };
inline constexpr int parameter_count = 6;

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

  int planes = 128;               // of the view-aligned plane stack
  float volume_resolution = 1.0F; // of the volume's picture, per display pixel and axis
  float opacity = 0.5F;           // of a voxel at the top of the window, per reference step
  bool box_visible = true;        // the wire-frame box
  bool frozen = false;            // the volume stays, the view still moves
  hal::TimePoint frozen_since{};  // when `frozen` became true
  int b_scan = 40;                // position of the B-scan panel, an index on the slow axis

  Parameter selected = Parameter::window_offset; // what the knob turns
  hal::TimePoint echo_until{}; // until then the display shows the selected parameter and its value

  ViewState clamped() const; // every value brought into its range

  bool operator==(const ViewState&) const = default;
};

struct ParameterRange {
  float lowest;
  float highest;
  float detent; // what one click of the knob changes
};

// The ranges of clamped(); the last B-scan is b_scans − 1.
ParameterRange parameter_range(Parameter parameter, int b_scans);
float parameter_value(const ViewState& view, Parameter parameter);

} // namespace octascope::ui
