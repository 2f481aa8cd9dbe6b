// Reads a device's report descriptor. Hides the differences between hidapi's versions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct hid_device_;

namespace octascope::hal::linux_backend {

// `device` is the open `node` ("/dev/hidraw0"). Empty if the descriptor is not available.
std::vector<std::uint8_t> report_descriptor_of(hid_device_* device, const std::string& node);

} // namespace octascope::hal::linux_backend
