#include "hal/linux/v4l2/pixel_formats.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace octascope::hal::linux_backend {

namespace {

constexpr std::array known{
    LinePixelFormat{fourcc('G', 'R', 'E', 'Y'), SampleType::u8, 8},
    LinePixelFormat{fourcc('Y', '1', '0', ' '), SampleType::u16, 10},
    LinePixelFormat{fourcc('Y', '1', '2', ' '), SampleType::u16, 12},
    LinePixelFormat{fourcc('Y', '1', '4', ' '), SampleType::u16, 14},
    LinePixelFormat{fourcc('Y', '1', '6', ' '), SampleType::u16, 16},
};

constexpr std::array packed{
    fourcc('Y', '1', '0', 'B'), fourcc('Y', '1', '0', 'P'), fourcc('Y', '1', '2', 'P'),
    fourcc('Y', '1', '4', 'P'), fourcc('i', 'p', '3', 'y'),
};

} // namespace

std::span<const LinePixelFormat> line_pixel_formats() {
  return known;
}

const LinePixelFormat* line_pixel_format(std::uint32_t code) {
  const auto found = std::ranges::find(known, code, &LinePixelFormat::code);
  return found == known.end() ? nullptr : &*found;
}

std::string fourcc_text(std::uint32_t code) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const std::uint32_t letter = code >> (8 * i) & (i == 3 ? 0x7FU : 0xFFU);
    if (letter > ' ' && letter < 0x7F)
      text += static_cast<char>(letter);
    else if (letter != ' ')
      text += fmt::format("\\x{:02x}", letter);
  }
  return (code & big_endian_mark) != 0 ? text + " (big-endian)" : text;
}

std::string_view why_unreadable(std::uint32_t code) {
  if ((code & big_endian_mark) != 0 && line_pixel_format(code & ~big_endian_mark) != nullptr)
    return "big-endian samples, expected little-endian ones";
  if (std::ranges::find(packed, code) != packed.end())
    return "packed samples, expected one in each 16 bits";
  return "no plain grey-scale samples";
}

} // namespace octascope::hal::linux_backend
