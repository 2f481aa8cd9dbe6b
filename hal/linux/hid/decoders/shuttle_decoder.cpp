#include "hal/linux/hid/decoders/shuttle_decoder.h"

namespace octascope::hal::linux_backend {

namespace {
constexpr std::size_t report_size = 5;
constexpr int ring_end = 7;
constexpr std::size_t ring_axis = 5; // rotation about z
} // namespace

std::optional<HidReading> ShuttleDecoder::do_decode(std::span<const std::uint8_t> report) {
  if (report.size() != report_size)
    return std::nullopt;
  const int ring = static_cast<std::int8_t>(report[0]);
  if (ring < -ring_end || ring > ring_end)
    return std::nullopt;
  const std::uint8_t jog = report[1];
  const std::uint32_t buttons = report[3] | (static_cast<std::uint32_t>(report[4]) << 8U);
  HidReading reading{.switches = (buttons >> first_button_) & mask_};
  if (jog_) // the shorter way round
    reading.knob = static_cast<std::int8_t>(static_cast<std::uint8_t>(jog - *jog_));
  jog_ = jog;
  reading.axes_told = 1U << ring_axis;
  reading.axes[ring_axis] = static_cast<std::int16_t>(ring * 1000 / ring_end);
  return reading;
}

} // namespace octascope::hal::linux_backend
