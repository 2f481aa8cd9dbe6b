// The pixel formats that can be read as a line camera's spectra, and why others cannot. Names and
// layouts: the kernel's list of grey-scale formats, linux/videodev2.h. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hal/line_camera.h"

namespace octascope::hal::linux_backend {

constexpr std::uint32_t fourcc(char a, char b, char c, char d) {
  const auto byte = [](char letter) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(letter));
  };
  return byte(a) | byte(b) << 8 | byte(c) << 16 | byte(d) << 24;
}

constexpr std::uint32_t big_endian_mark = 1U << 31;

// Samples of `bits` bits, right-justified in a `type`. If `bits` is the whole type, the camera may
// use fewer, also left-justified.
struct LinePixelFormat {
  std::uint32_t code;
  SampleType type;
  int bits;
};

std::span<const LinePixelFormat> line_pixel_formats();

// Null for formats that cannot be read without a conversion.
const LinePixelFormat* line_pixel_format(std::uint32_t code);

// "Y12", "Y16 (big-endian)"; bytes that are not printable as \x00.
std::string fourcc_text(std::uint32_t code);

// Why a format that is not in the list cannot be used.
std::string_view why_unreadable(std::uint32_t code);

} // namespace octascope::hal::linux_backend
