#include "hal/linux/hid/raw/raw_device.h"

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <tuple>

#include <fcntl.h>
#include <hidapi.h>
#include <linux/hidraw.h>

#include "hal/linux/hid/raw/report_descriptor.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

// hidapi's words are wide, and ASCII but for names.
std::string narrow(const wchar_t* words) {
  std::string text;
  for (; *words != 0; ++words)
    text += *words < 0x80 ? static_cast<char>(*words) : '?';
  return text;
}

// hidapi tells no errno, so the node is asked. It stays open while hidapi opens it once more, which
// is quicker then: hidapi 0.13 crashes where a device goes between its open() and its first
// ioctl().
Result<FileDescriptor> ask(const std::string& node) {
  auto file = open_device(node, O_RDWR | O_NONBLOCK);
  hidraw_devinfo info{};
  if (file && control(*file, HIDIOCGRAWINFO, &info) != 0)
    return system_failure(node, "asking what it is", errno == ENODEV ? ENOENT : errno);
  return file;
}

} // namespace

std::vector<RawNode> list_raw_nodes() {
  const HidapiLibrary library;
  const auto lock = library.lock();
  hid_device_info* const listed = hid_enumerate(0, 0);
  std::vector<RawNode> nodes;
  for (const hid_device_info* device = listed; device != nullptr; device = device->next)
    if (device->path != nullptr)
      nodes.push_back({device->path, device->vendor_id, device->product_id});
  hid_free_enumeration(listed);
  std::ranges::sort(nodes, {}, [](const RawNode& node) {
    return std::tuple{node.node.size(), std::string_view{node.node}};
  });
  // hidapi lists a device once for each usage in its descriptor.
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void RawDevice::Closer::operator()(hid_device_* device) const {
  hid_close(device);
}

Result<std::unique_ptr<RawDevice>> RawDevice::open(const std::string& node) {
  HAL_TRY(const auto asked, ask(node));
  std::unique_ptr<RawDevice> opened{new RawDevice{node}};
  const auto lock = opened->library_.lock();
  opened->device_.reset(hid_open_path(node.c_str()));
  if (opened->device_)
    return opened;
  if (const auto again = ask(node); !again) // it went meanwhile
    return tl::make_unexpected(again.error());
  return fail(ErrorCode::system,
              "{}: found a device that may be opened, and hidapi did not open it: {}; it is tried "
              "again by itself",
              node, narrow(hid_error(nullptr)));
}

Result<std::size_t> RawDevice::read(std::span<std::uint8_t> report,
                                    std::chrono::milliseconds timeout) {
  // hidapi does not say why it failed. What a signal broke off works at the next try; a device that
  // is gone fails each time.
  for (int tries = 0; tries < 3; ++tries) {
    const int size = hid_read_timeout(device_.get(), report.data(), report.size(),
                                      static_cast<int>(timeout.count()));
    if (size >= 0)
      return static_cast<std::size_t>(size);
  }
  return system_failure(node_, "reading", ENODEV);
}

bool RawDevice::write(std::span<const std::uint8_t> report) {
  return hid_write(device_.get(), report.data(), report.size()) == std::ssize(report);
}

std::vector<std::uint8_t> RawDevice::report_descriptor() const {
  return report_descriptor_of(device_.get(), node_);
}

} // namespace octascope::hal::linux_backend
