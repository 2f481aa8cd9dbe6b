#include "hal/linux/system/device_watch.h"

#include <cerrno>
#include <string_view>

#include <fmt/format.h>
#include <libudev.h>
#include <poll.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

DeviceChange::Kind kind_of(std::string_view action) {
  if (action == "add")
    return DeviceChange::Kind::added;
  if (action == "remove")
    return DeviceChange::Kind::removed;
  return DeviceChange::Kind::changed;
}

std::string text(const char* maybe) {
  return maybe != nullptr ? maybe : "";
}

} // namespace

struct DeviceWatch::Monitor {
  udev* context = nullptr;
  udev_monitor* monitor = nullptr;

  Monitor() = default;
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;
  ~Monitor() {
    if (monitor != nullptr)
      udev_monitor_unref(monitor);
    if (context != nullptr)
      udev_unref(context);
  }
};

Result<DeviceWatch> DeviceWatch::on(const char* subsystem) {
  auto made = std::make_unique<Monitor>();
  made->context = udev_new();
  if (made->context == nullptr)
    return system_failure("udev", "making a context", errno);
  const bool has_daemon = ::access("/run/udev/control", F_OK) == 0;
  made->monitor = udev_monitor_new_from_netlink(made->context, has_daemon ? "udev" : "kernel");
  if (made->monitor == nullptr)
    return system_failure("udev", "opening its event socket", errno);
  if (udev_monitor_filter_add_match_subsystem_devtype(made->monitor, subsystem, nullptr) < 0 ||
      udev_monitor_enable_receiving(made->monitor) < 0)
    return system_failure("udev", fmt::format("watching \"{}\"", subsystem), errno);
  return DeviceWatch{std::move(made)};
}

DeviceWatch::DeviceWatch(std::unique_ptr<Monitor> monitor) : monitor_{std::move(monitor)} {}
DeviceWatch::DeviceWatch(DeviceWatch&&) noexcept = default;
DeviceWatch& DeviceWatch::operator=(DeviceWatch&&) noexcept = default;
DeviceWatch::~DeviceWatch() = default;

std::optional<DeviceChange> DeviceWatch::next(Duration timeout) {
  pollfd waiting{descriptor(), POLLIN, 0};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  if (::poll(&waiting, 1, static_cast<int>(ms)) <= 0)
    return std::nullopt;
  udev_device* const device = udev_monitor_receive_device(monitor_->monitor);
  if (device == nullptr)
    return std::nullopt;
  DeviceChange change{kind_of(text(udev_device_get_action(device))),
                      text(udev_device_get_devnode(device)), text(udev_device_get_syspath(device))};
  udev_device_unref(device);
  return change;
}

int DeviceWatch::descriptor() const {
  return udev_monitor_get_fd(monitor_->monitor);
}

} // namespace octascope::hal::linux_backend
