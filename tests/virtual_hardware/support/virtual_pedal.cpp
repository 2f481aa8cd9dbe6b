#include "tests/virtual_hardware/support/virtual_pedal.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include "hal/linux/system/device_watch.h"
#include "hal/linux/system/system_error.h"
#include "tests/virtual_hardware/support/device_node.h"

namespace octascope::tests {

using hal::Result;
using hal::linux_backend::open_device;
using hal::linux_backend::system_failure;
namespace fs = std::filesystem;

namespace {

constexpr const char* uhid_node = "/dev/uhid";

Result<> send_event(const hal::linux_backend::FileDescriptor& uhid, const uhid_event& event,
                    const char* what) {
  if (::write(uhid.get(), &event, sizeof event) < 0)
    return system_failure(uhid_node, what, errno);
  return {};
}

// Whether the device of that name got its driver within 5 s ("bind", a change). Its node is there
// before, but what it sends before is dropped.
bool gets_its_driver(hal::linux_backend::DeviceWatch& watch, const std::string& name) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds{5};
  while (std::chrono::steady_clock::now() < limit) {
    const auto change = watch.next(limit - std::chrono::steady_clock::now());
    if (change && change->kind == hal::linux_backend::DeviceChange::Kind::changed &&
        change->path.find(name) != std::string::npos)
      return true;
  }
  return false;
}

// The first entry of `folder`, below /dev.
std::string node_in(const fs::path& folder, const std::string& dev, const std::string& prefix) {
  std::error_code error;
  for (fs::recursive_directory_iterator it{folder, error}, end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with(prefix) && name.size() > prefix.size() && it->is_directory() &&
        !it->is_symlink())
      return dev + name;
  }
  return {};
}

// Short for what descriptors are made of: `count` fields of `bits` bits, signed or not, of a page
// and usage, as input or output.
void fields(std::vector<std::uint8_t>& to, std::uint8_t report, std::uint8_t bits,
            std::uint8_t count, bool is_signed, bool output = false) {
  if (report != 0)
    to.insert(to.end(), {0x85, report});
  if (is_signed)
    to.insert(to.end(), {0x16, 0x00, 0x80, 0x26, 0xff, 0x7f}); // −32768…32767
  else
    to.insert(to.end(), {0x15, 0x00, 0x26, 0xff, 0x00}); // 0…255
  to.insert(to.end(), {0x75, bits, 0x95, count, 0x09, 0x02});
  to.insert(to.end(), {output ? std::uint8_t{0x91} : std::uint8_t{0x81}, 0x02});
}

// A collection of a vendor's own usages.
template <class Fill> std::vector<std::uint8_t> vendor_descriptor(Fill&& fill) {
  std::vector<std::uint8_t> bytes{0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01};
  fill(bytes);
  bytes.push_back(0xc0);
  return bytes;
}

VirtualPedalKind plain(std::uint16_t vendor, std::uint16_t product, const char* name,
                       std::uint8_t size) {
  return {vendor, product, name,
          vendor_descriptor([&](auto& to) { fields(to, 0, 8, size, false); })};
}

} // namespace

std::string virtual_pedal_missing() {
  if (::access(uhid_node, F_OK) != 0)
    return "there is no /dev/uhid: this kernel makes no virtual HID devices";
  if (::access(uhid_node, R_OK | W_OK) != 0)
    return "no permission to open /dev/uhid";
  return {};
}

VirtualPedalKind vec_pedal() {
  return plain(0x05f3, 0x00ff, "VEC VEC USB Footpedal", 2);
}
VirtualPedalKind philips_pedal() {
  return plain(0x0911, 0x1844, "Philips Speech Processing Foot Control", 8);
}
VirtualPedalKind shuttle_xpress() {
  return plain(0x0b33, 0x0020, "Contour Design ShuttleXpress", 5);
}
VirtualPedalKind shuttle_pro() {
  return plain(0x0b33, 0x0030, "Contour Design ShuttlePRO v2", 5);
}
VirtualPedalKind space_navigator() {
  return {0x046d, 0xc626, "3Dconnexion SpaceNavigator", vendor_descriptor([](auto& to) {
            fields(to, 1, 16, 3, true);
            fields(to, 2, 16, 3, true);
            fields(to, 3, 8, 2, false);
            fields(to, 4, 8, 1, false, true);
          })};
}
VirtualPedalKind space_mouse() {
  return {0x256f, 0xc62e, "3Dconnexion SpaceMouse Wireless", vendor_descriptor([](auto& to) {
            fields(to, 1, 16, 6, true);
            fields(to, 3, 8, 2, false);
          })};
}
VirtualPedalKind surface_dial() {
  return {0x045e, 0x091b, "Surface Dial",
          vendor_descriptor([](auto& to) { fields(to, 1, 8, 7, false); })};
}

// The boot keyboard's report, with an ID: modifiers, a constant byte, six keys.
VirtualPedalKind pcsensor_pedal(std::string name) {
  return {0x1a86, 0xe026, std::move(name), {0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0x85, 0x01,
                                            0x05, 0x07, 0x19, 0xe0, 0x29, 0xe7, 0x15, 0x00,
                                            0x25, 0x01, 0x75, 0x01, 0x95, 0x08, 0x81, 0x02,
                                            0x95, 0x01, 0x75, 0x08, 0x81, 0x01, 0x95, 0x06,
                                            0x75, 0x08, 0x15, 0x00, 0x25, 0x65, 0x05, 0x07,
                                            0x19, 0x00, 0x29, 0x65, 0x81, 0x00, 0xc0}};
}

Result<std::unique_ptr<VirtualPedal>> VirtualPedal::plug_in(const VirtualPedalKind& kind) {
  static std::atomic<unsigned> made{0};                    // serial numbers differ within a process
  auto watch = hal::linux_backend::DeviceWatch::on("hid"); // before there is anything to tell
  if (!watch)
    return tl::make_unexpected(watch.error());
  std::unique_ptr<VirtualPedal> pedal{new VirtualPedal};
  HAL_TRY(auto file, open_device(uhid_node, O_RDWR | O_NONBLOCK));
  pedal->uhid_ = std::move(file);
  pedal->unique_ = "octascope-" + std::to_string(::getpid()) + "-" + std::to_string(made++);
  pedal->id_ = fmt::format(":{:04X}:{:04X}.", kind.vendor, kind.product);
  uhid_event event{};
  event.type = UHID_CREATE2;
  auto& create = event.u.create2;
  const auto copy = [](auto& to, const std::string& from) {
    std::memcpy(to, from.data(), std::min(from.size(), sizeof to - 1));
  };
  copy(create.name, kind.name);
  copy(create.phys, kind.phys);
  copy(create.uniq, pedal->unique_);
  create.rd_size = static_cast<std::uint16_t>(kind.descriptor.size());
  std::memcpy(create.rd_data, kind.descriptor.data(), kind.descriptor.size());
  create.bus = BUS_USB;
  create.vendor = kind.vendor;
  create.product = kind.product;
  HAL_CHECK(send_event(pedal->uhid_, event, "making a device"));
  // The kernel makes it on a worker of its own.
  if (!gets_its_driver(*watch, pedal->id_))
    return hal::fail(hal::ErrorCode::timed_out,
                     kind.name + ": no driver within 5 s; see `dmesg` for what it objects to");
  if (!node_appears([&] { return pedal->hidraw_node(); }))
    return hal::fail(hal::ErrorCode::timed_out, kind.name + ": no hidraw node within 5 s");
  return pedal;
}

VirtualPedal::~VirtualPedal() {
  uhid_event event{};
  event.type = UHID_DESTROY;
  (void)send_event(uhid_, event, "destroying a device");
}

Result<> VirtualPedal::send(std::span<const std::uint8_t> report) {
  uhid_event event{};
  event.type = UHID_INPUT2;
  event.u.input2.size = static_cast<std::uint16_t>(report.size());
  std::memcpy(event.u.input2.data, report.data(), report.size());
  return send_event(uhid_, event, "sending a report");
}

std::optional<std::vector<std::uint8_t>> VirtualPedal::output() {
  pollfd waiting{uhid_.get(), POLLIN, 0};
  while (::poll(&waiting, 1, 2000) > 0) {
    uhid_event event{};
    if (::read(uhid_.get(), &event, sizeof event) <= 0)
      return std::nullopt;
    if (event.type == UHID_OUTPUT)
      return std::vector<std::uint8_t>{event.u.output.data,
                                       event.u.output.data + event.u.output.size};
  }
  return std::nullopt;
}

std::string VirtualPedal::sysfs_folder() const {
  std::error_code error;
  for (fs::directory_iterator it{"/sys/bus/hid/devices", error}, end; !error && it != end;
       it.increment(error)) {
    if (it->path().filename().string().find(id_) == std::string::npos)
      continue;
    std::ifstream uevent{it->path() / "uevent"};
    for (std::string line; std::getline(uevent, line);)
      if (line == "HID_UNIQ=" + unique_)
        return fs::canonical(it->path(), error).string();
  }
  return {};
}

std::string VirtualPedal::hidraw_node() const {
  const std::string folder = sysfs_folder();
  return folder.empty() ? "" : node_in(folder + "/hidraw", "/dev/", "hidraw");
}

std::string VirtualPedal::event_node() const {
  const std::string folder = sysfs_folder();
  return folder.empty() ? "" : node_in(folder + "/input", "/dev/input/", "event");
}

} // namespace octascope::tests
