// What a monitor calls itself. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace octascope::hal::linux_backend::kms {

// From the EDID's base block (VESA E-EDID 1.4): the monitor's name, printable ASCII only; where it
// has none, maker and product ("DEL a0c4"). Empty where the bytes are no EDID or its sum is wrong.
std::string monitor_name(std::span<const std::uint8_t> edid);

} // namespace octascope::hal::linux_backend::kms
