// Pedals whose first byte has one bit per switch: VEC Infinity (0x01 left, 0x02 centre, 0x04 right)
// and Philips (bits 0–3: rewind, play, forward, end).
#pragma once

#include "hal/linux/hid/decoders/hid_decoder.h"

namespace octascope::hal::linux_backend {

class PedalDecoder final : public HidDecoder {
public:
  explicit PedalDecoder(int switches) : mask_((1U << switches) - 1) {}

private:
  std::optional<HidReading> do_decode(std::span<const std::uint8_t> report) override {
    if (report.empty())
      return std::nullopt;
    return HidReading{.switches = report[0] & mask_};
  }

  std::uint32_t mask_;
};

// Any bits of a learned device.
class MappedDecoder final : public HidDecoder {
public:
  MappedDecoder(std::vector<SwitchBit> bits, std::optional<std::uint8_t> report_id)
      : bits_(std::move(bits)), report_id_(report_id) {}

private:
  std::optional<HidReading> do_decode(std::span<const std::uint8_t> report) override {
    if (report.empty() || (report_id_ && report[0] != *report_id_))
      return std::nullopt;
    std::uint32_t down = 0;
    for (std::size_t i = 0; i < bits_.size(); ++i) {
      if (bits_[i].byte >= report.size()) // another, shorter report
        return std::nullopt;
      if ((report[bits_[i].byte] & bits_[i].mask) != 0)
        down |= 1U << i;
    }
    return HidReading{.switches = down};
  }

  std::vector<SwitchBit> bits_;
  std::optional<std::uint8_t> report_id_;
};

} // namespace octascope::hal::linux_backend
