// Contour ShuttleXpress and ShuttlePro: int8 ring −7…7, u8 jog that wraps, 0, u16le buttons.
#pragma once

#include "hal/linux/hid/decoders/hid_decoder.h"

namespace octascope::hal::linux_backend {

// The jog's position is unknown before the first report, so that report gives no detents. The
// device itself drops the first detent after the jog changes direction.
class ShuttleDecoder final : public HidDecoder {
public:
  ShuttleDecoder(int switches, unsigned first_button)
      : mask_((1U << switches) - 1), first_button_(first_button) {}

private:
  std::optional<HidReading> do_decode(std::span<const std::uint8_t> report) override;

  std::uint32_t mask_;
  unsigned first_button_;
  std::optional<std::uint8_t> jog_;
};

} // namespace octascope::hal::linux_backend
