// The monitor's name from its EDID. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace octascope::hal::linux_backend::kms {

// From the EDID's base block (VESA E-EDID 1.4): the monitor's name, printable ASCII only, or, if it
// has none, manufacturer and product ("DEL a0c4"). Empty if the EDID or its checksum is invalid.
std::string monitor_name(std::span<const std::uint8_t> edid);

} // namespace octascope::hal::linux_backend::kms
