// Microsoft Surface Dial: report 1; byte 1, bit 0: pressed; bytes 2–3: rotation, i16le, 3600 counts
// per revolution.
#pragma once

#include "hal/linux/hid/decoders/hid_decoder.h"

namespace octascope::hal::linux_backend {

// Ten counts are one detent; the remainder is kept for the next report.
class SurfaceDialDecoder final : public HidDecoder {
private:
  std::optional<HidReading> do_decode(std::span<const std::uint8_t> report) override {
    constexpr int counts_per_detent = 10;
    if (report.size() < 4 || report[0] != 1)
      return std::nullopt;
    counts_ += static_cast<std::int16_t>(static_cast<std::uint16_t>(report[2] | (report[3] << 8)));
    const int detents = counts_ / counts_per_detent;
    counts_ -= detents * counts_per_detent;
    return HidReading{.switches = report[1] & 1U, .knob = detents};
  }

  int counts_ = 0;
};

} // namespace octascope::hal::linux_backend
