// Images as PNG files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "hal/result.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::pipeline {

// 8 bits per channel, rows from the top without padding.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 3; // 1: grey, 3: RGB, 4: RGB and opacity
  std::vector<std::uint8_t> pixels;

  Image() = default;
  Image(int w, int h, int c)
      : width(w), height(h), channels(c),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
               static_cast<std::size_t>(c)) {}
  // Only for an RGB image; (0, 0) is the upper left corner.
  std::array<std::uint8_t, 3> pixel(int x, int y) const {
    const auto i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)) *
                   3;
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
  }
  bool operator==(const Image&) const = default;
};

// Grey and RGB. The file appears complete or not at all.
hal::Result<> write_png(const std::filesystem::path& file, const Image& image,
                        Readers readers = Readers::as_the_umask_allows);

// Grey files become grey, all others RGB; transparent pixels are blended onto black.
hal::Result<Image> read_png(const std::filesystem::path& file);

// A picture of plain numbers, as they are in the file: a pixel is value / greatest.
struct NumberImage {
  int width = 0;
  int height = 0;
  int channels = 0;                  // 1: grey, 2: grey and opacity, 3: RGB, 4: RGB and opacity
  int greatest = 0;                  // 255 or 65535
  std::vector<std::uint16_t> values; // rows from the top without padding
};

// Ignores what the file says about colour (gAMA, sRGB, cHRM, iCCP) and does not multiply by
// opacity; 16 bits stay 16, 1, 2 and 4 bits become 8, and a palette is resolved. Up to
// `most_pixels` on each side. ErrorCode::absent, denied, invalid_argument: as InputFile.
hal::Result<NumberImage> read_png_numbers(const std::filesystem::path& file, int most_pixels);

} // namespace octascope::pipeline
