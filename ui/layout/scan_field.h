// Where the OCT scans within the microscope's picture.
#pragma once

#include <array>

namespace octascope::ui {

// Corners in order around the field, as shares of the picture's width and height from its top left
// corner. The scan begins at the first (A-scan 0 of B-scan 0); B-scan 0 ends at the second.
struct ScanField {
  struct Corner {
    float x = 0;
    float y = 0;
    bool operator==(const Corner&) const = default;
  };
  std::array<Corner, 4> corners;
  bool operator==(const ScanField&) const = default;
};

} // namespace octascope::ui
