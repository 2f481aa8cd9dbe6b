#include "hal/linux/hid/raw/report_descriptor.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <hidapi.h>

namespace octascope::hal::linux_backend {

#if HID_API_VERSION >= HID_API_MAKE_VERSION(0, 14, 0)
std::vector<std::uint8_t> report_descriptor_of(hid_device_* device, const std::string&) {
  std::vector<std::uint8_t> bytes(HID_API_MAX_REPORT_DESCRIPTOR_SIZE);
  const int size = hid_get_report_descriptor(device, bytes.data(), bytes.size());
  bytes.resize(static_cast<std::size_t>(std::max(size, 0)));
  return bytes;
}
#else
std::vector<std::uint8_t> report_descriptor_of(hid_device_*, const std::string& node) {
  const std::filesystem::path hidraw = std::filesystem::path{node}.filename();
  std::ifstream file{"/sys/class/hidraw" / hidraw / "device/report_descriptor", std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}
#endif

} // namespace octascope::hal::linux_backend
