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

// The same, but files with transparency become RGB and opacity, not premultiplied.
hal::Result<Image> read_png_with_opacity(const std::filesystem::path& file);

} // namespace octascope::pipeline
