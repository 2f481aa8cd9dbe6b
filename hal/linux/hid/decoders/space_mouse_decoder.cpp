#include "hal/linux/hid/decoders/space_mouse_decoder.h"

#include <algorithm>

namespace octascope::hal::linux_backend {

namespace {

constexpr int full_deflection = 350;
constexpr std::size_t three_axes = 7, six_axes = 13; // bytes, with the report's ID

int i16le(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8)));
}

HidReading axes(std::span<const std::uint8_t> report, std::size_t first, std::size_t count) {
  HidReading reading;
  for (std::size_t i = 0; i < count; ++i) {
    const int value = i16le(report, 1 + 2 * i) * 1000 / full_deflection;
    reading.axes[first + i] = static_cast<std::int16_t>(std::clamp(value, -1000, 1000));
    reading.axes_told |= static_cast<std::uint8_t>(1U << (first + i));
  }
  return reading;
}

} // namespace

std::optional<HidReading> SpaceMouseDecoder::do_decode(std::span<const std::uint8_t> report) {
  if (report.size() < 2)
    return std::nullopt;
  switch (report[0]) {
  case 1:
    if (report.size() >= six_axes)
      return axes(report, 0, 6);
    if (report.size() >= three_axes)
      return axes(report, 0, 3);
    return std::nullopt;
  case 2:
    if (report.size() >= three_axes)
      return axes(report, 3, 3);
    return std::nullopt;
  case 3: return HidReading{.switches = report[1] & mask_};
  default: return std::nullopt; // battery and the like
  }
}

} // namespace octascope::hal::linux_backend
