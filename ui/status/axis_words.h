// What stands at the ends of the volume's axes. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "pipeline/volume/eye.h"

namespace octascope::ui {

enum class Side : std::uint8_t { superior, inferior, nasal, temporal };
std::string_view to_string(Side side); // "superior"
std::string_view letter_of(Side side); // "S"
std::optional<Side> side_named(std::string_view name);
Side opposite(Side side);
// Whether both lie on one line through the eye.
bool along_one_line(Side a, Side b);

// How the scan lies on a right eye: where x (along a B-scan) and y (from B-scan to B-scan) point
// to. Either both or none is said; they are perpendicular.
struct ScanOnEye {
  std::optional<Side> right_eye_x;
  std::optional<Side> right_eye_y;
  bool operator==(const ScanOnEye&) const = default;
};

// The user's own names of the axes; empty: x, y, z.
struct AxisLabels {
  std::array<std::string, 3> names; // x, y and z, which is the depth
  bool operator==(const AxisLabels&) const = default;
};

// From the configuration.
struct ScanOrientation {
  ScanOnEye on_eye;
  AxisLabels labels;
  bool operator==(const ScanOrientation&) const = default;
};

// What is written at the two ends of x and y: sides of the eye, or nothing.
struct AxisEnds {
  std::optional<Side> x_begin, x_end, y_begin, y_end;
  bool said() const { return x_end.has_value(); }
  bool operator==(const AxisEnds&) const = default;
};

// Empty unless somebody said which eye it is and how the scan lies on it. On a left eye nasal and
// temporal change places, superior and inferior do not.
AxisEnds ends_of(const ScanOnEye& scan, pipeline::Eye eye);

} // namespace octascope::ui
