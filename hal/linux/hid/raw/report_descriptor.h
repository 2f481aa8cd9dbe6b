// What a device says its reports are made of. The only place that knows how hidapi's versions
// differ in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct hid_device_;

namespace octascope::hal::linux_backend {

// Of an open device, which is `node` ("/dev/hidraw0"). Empty: it is not told.
std::vector<std::uint8_t> report_descriptor_of(hid_device_* device, const std::string& node);

} // namespace octascope::hal::linux_backend
