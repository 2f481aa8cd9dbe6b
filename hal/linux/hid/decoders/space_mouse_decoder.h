// 3Dconnexion pucks: report 1 has three translations or all six axes, report 2 three rotations,
// report 3 the buttons. i16le, ±350 at the stops.
#pragma once

#include "hal/linux/hid/decoders/hid_decoder.h"

namespace octascope::hal::linux_backend {

class SpaceMouseDecoder final : public HidDecoder {
public:
  explicit SpaceMouseDecoder(int switches) : mask_((1U << switches) - 1) {}

private:
  std::optional<HidReading> do_decode(std::span<const std::uint8_t> report) override;

  std::uint32_t mask_;
};

} // namespace octascope::hal::linux_backend
