// What a screen shows, read back from the frame buffer that its output scans: for tests that look
// at a display as a camera would, from outside the program that draws.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/result.h"

namespace octascope::tests {

struct ScanoutPicture {
  int width = 0; // in pixels
  int height = 0;
  std::vector<std::uint8_t> rgb; // red, green, blue of each pixel; the top row first

  const std::uint8_t* pixel(int x, int y) const {
    return rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
  }
};

// Of the first output that is on, of `card` ("/dev/dri/card0") or, where that is empty, of any
// card. Needs root: to others the kernel does not show what is on the screen. ErrorCode::absent: no
// output is on. ErrorCode::unsupported: a format or a layout of pixels that is not plain 8 bits a
// colour.
hal::Result<ScanoutPicture> read_scanout(const std::string& card = {});

// Of a pixel near the corner; -1: no output is on.
inline int red_on_screen() {
  const auto picture = read_scanout();
  return picture ? picture->pixel(7, 7)[0] : -1;
}

// The largest difference of two colour values, of 255; 256 where the sizes differ.
int largest_difference(const ScanoutPicture& a, const ScanoutPicture& b);

} // namespace octascope::tests
