// Decodes the reports of controls. Pure: no device, no clock, no allocation after construction, so
// decoders can be fuzzed and tested with recorded bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "hal/linux/hid/models/control_model.h"

namespace octascope::hal::linux_backend {

inline constexpr std::size_t control_axes = 6;

// The contents of one report. Values that it does not contain are empty or 0.
struct HidReading {
  std::optional<std::uint32_t> switches = {}; // bit n: switch n is down
  std::int32_t knob = 0;      // detents since the last reading, clockwise is positive
  std::uint8_t axes_told = 0; // bit n: the report contains axes[n]
  std::array<std::int16_t, control_axes> axes{}; // −1000…1000; x y z, rotations about them
  bool operator==(const HidReading&) const = default;
};

// Threads: one at a time. Some decoders keep state from the previous report.
class HidDecoder {
public:
  virtual ~HidDecoder() = default;
  // Decodes one report as hidraw delivers it, beginning with its ID if the device uses report IDs.
  // Empty if it is not a report of this device.
  std::optional<HidReading> decode(std::span<const std::uint8_t> report) {
    return do_decode(report);
  }

private:
  virtual std::optional<HidReading> do_decode(std::span<const std::uint8_t> report) = 0;
};

// Null for a model whose events come as keys (key_decoder.h).
std::unique_ptr<HidDecoder> make_hid_decoder(const ControlModel& model);

} // namespace octascope::hal::linux_backend
