// Where the OCT scans within the microscope's picture.
#pragma once

#include <array>

namespace octascope::ui {

// Corners in their order around the field, as shares of the picture's width and height from its top
// left corner. The first is where the scan begins: A-scan 0 of B-scan 0; the second ends B-scan 0.
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
