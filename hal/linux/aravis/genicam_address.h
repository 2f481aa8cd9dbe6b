// The name by which a configuration asks for a GenICam camera. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct GenicamAddress {
  enum class Bus : std::uint8_t { usb3_vision, gige_vision } bus = Bus::usb3_vision;
  // USB3 Vision: serial number, "Vendor-Serial" or the name that its user gave it; empty: the first
  // camera. GigE Vision: an IPv4 address, as nothing is looked for on a network.
  std::string name;

  // A camera on the machine's own loopback is a program: its data are nobody's.
  bool simulated() const;

  bool operator==(const GenicamAddress&) const = default;
};

// "usb3vision", "usb3vision:NAME" and "gigevision:ADDRESS"; nothing for names of other cameras.
// ErrorCode::invalid_argument: a GigE camera without its address, or an address that is none.
Result<std::optional<GenicamAddress>> parse_genicam_address(std::string_view text);

// As it is written in a configuration.
std::string to_text(const GenicamAddress& address);

} // namespace octascope::hal::linux_backend
