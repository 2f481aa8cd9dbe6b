#include "hal/linux/libcamera/media_events.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <vector>

#include <libudev.h>
#include <linux/filter.h>
#include <linux/netlink.h>
#include <sys/socket.h>

#include "hal/linux/system/system_error.h"
#include "hal/linux/system/system_files.h"

namespace octascope::hal::linux_backend {

namespace {

using Filter = std::vector<sock_filter>;

// Empty where the socket has none.
Filter filter_of(int socket) {
  socklen_t instructions = 0;
  if (::getsockopt(socket, SOL_SOCKET, SO_GET_FILTER, nullptr, &instructions) != 0)
    return {};
  Filter filter(instructions);
  if (instructions > 0 &&
      ::getsockopt(socket, SOL_SOCKET, SO_GET_FILTER, filter.data(), &instructions) != 0)
    return {};
  return filter;
}

// The one that libudev makes.
Result<Filter> filter_for(std::initializer_list<const char*> subsystems) {
  const std::unique_ptr<udev, decltype(&udev_unref)> context{udev_new(), &udev_unref};
  if (context == nullptr)
    return system_failure("udev", "making a context", errno);
  const std::unique_ptr<udev_monitor, decltype(&udev_monitor_unref)> monitor{
      udev_monitor_new_from_netlink(context.get(), "udev"), &udev_monitor_unref};
  if (monitor == nullptr)
    return system_failure("udev", "opening its event socket", errno);
  for (const char* const subsystem : subsystems)
    udev_monitor_filter_add_match_subsystem_devtype(monitor.get(), subsystem, nullptr);
  if (udev_monitor_filter_update(monitor.get()) < 0)
    return system_failure("udev", "choosing its events", errno);
  return filter_of(udev_monitor_get_fd(monitor.get()));
}

// libudev keeps the subsystems in a table by their hashes, whose key changes as the process goes on: the
// instructions for each come in any order.
bool passes_the_same(const Filter& a, const Filter& b) {
  return std::ranges::is_permutation(a, b, [](const sock_filter& x, const sock_filter& y) {
    return x.code == y.code && x.jt == y.jt && x.jf == y.jf && x.k == y.k;
  });
}

bool hears_of_devices(int descriptor) {
  int protocol = 0;
  socklen_t size = sizeof protocol;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_PROTOCOL, &protocol, &size) == 0 &&
         protocol == NETLINK_KOBJECT_UEVENT;
}

} // namespace

Result<int> keep_video_nodes_from_libcamera() {
  HAL_TRY(const Filter of_libcamera, filter_for({"media", "video4linux"}));
  HAL_TRY(Filter media_alone, filter_for({"media"}));
  if (of_libcamera.empty() || media_alone.empty())
    return fail(ErrorCode::system,
                "libcamera: found no way to read a socket's filter, expected SO_GET_FILTER, "
                "without which a camera that comes back may end the program; use Linux 3.8 or "
                "newer, or scope_camera = \"none\"");
  const sock_fprog program{static_cast<unsigned short>(media_alone.size()), media_alone.data()};
  int changed = 0;
  for (const auto& entry : entries("/proc/self/fd")) {
    const int descriptor = std::atoi(entry.filename().c_str());
    if (hears_of_devices(descriptor) && passes_the_same(filter_of(descriptor), of_libcamera)) {
      if (::setsockopt(descriptor, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) != 0)
        return system_failure("udev", "choosing libcamera's events", errno);
      ++changed;
    }
  }
  return changed;
}

} // namespace octascope::hal::linux_backend
