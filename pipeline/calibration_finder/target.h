// A flat target that shows which way round a scan is and how large: an F and bars of known pitch.
//
// The drawing is a square of 20 × 20 units, x to the right and y down:
//
//   F          x 0–3, y 0–12; x 3–11, y 0–3; x 3–8, y 5–8
//   bars in x  four, 2 units wide, 3 apart: x 0–2, 3–5, 6–8, 9–11, y 14–20
//   bars in y  seven, 2 units high, 3 apart: y 0–2, 3–5 … 18–20, x 14–20
//
// All four sides of the square are touched, and no turn or reflection of it looks like another one.
#pragma once

#include <span>
#include <string>

#include "hal/result.h"

namespace octascope::pipeline {

inline constexpr double target_side_mm = 2.4; // of the simulated one
inline constexpr int target_units = 20;

// Whether the drawing reflects at (x, y) in units.
bool target_reflects(double x, double y);

struct TargetMeasurement {
  // The picture from above, A-scans to the right and B-scans down, shows the drawing mirrored left
  // for right, if so, and then turned clockwise.
  bool mirrored = false;
  int quarter_turns = 0;
  double a_spacing_um = 0; // from the pitch of the bars across each axis
  double b_spacing_um = 0;
  double agreement = 0; // −1 … 1: 1 where every place is as in the drawing
  double runner_up = 0; // of the other seven ways round, the best

  bool upright() const { return !mirrored && quarter_turns == 0; }
};

// "upright", "mirrored and turned by 90° clockwise" …
std::string orientation_text(const TargetMeasurement& measurement);

// `en_face` is [b][a], brighter where there is more light, in decibels; the target lies within the
// scan as a whole, up to its border, turned by few degrees at most, with three samples or more a
// bar. ErrorCode::bad_data, with what was seen and what is probably wrong: no contrast; a picture
// that is not that of the drawing, as that of a target that is too small, or beyond the border.
hal::Result<TargetMeasurement> measure_target(std::span<const float> en_face, int a_scans,
                                              int b_scans, double side_um);

} // namespace octascope::pipeline
