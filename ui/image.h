// A picture read back from the display.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace octascope::ui {

// 8-bit RGB, rows from the top, no padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  std::array<std::uint8_t, 3> at(int x, int y) const {
    const auto i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)) *
                   3;
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
};

} // namespace octascope::ui
