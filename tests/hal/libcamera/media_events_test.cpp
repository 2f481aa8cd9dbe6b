// That libcamera's watch over devices hears of media devices alone, and others of what they asked for.
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <libudev.h>
#include <linux/filter.h>
#include <linux/netlink.h>
#include <sys/socket.h>

#include "hal/linux/libcamera/libcamera_session.h"
#include "hal/linux/system/system_error.h"
#include "hal/linux/system/system_files.h"

namespace octascope::tests {
namespace {

using Context = std::unique_ptr<udev, decltype(&udev_unref)>;
using Watch = std::unique_ptr<udev_monitor, decltype(&udev_monitor_unref)>;

Watch watch(const Context& context, const std::vector<std::string>& subsystems) {
  Watch made{udev_monitor_new_from_netlink(context.get(), "udev"), &udev_monitor_unref};
  for (const std::string& subsystem : subsystems)
    udev_monitor_filter_add_match_subsystem_devtype(made.get(), subsystem.c_str(), nullptr);
  if (udev_monitor_enable_receiving(made.get()) < 0)
    return {nullptr, &udev_monitor_unref};
  return made;
}

// The instructions of the filter that libudev gave a watch's socket: the more subsystems, the more.
socklen_t filter_length(int socket) {
  socklen_t instructions = 0;
  EXPECT_EQ(::getsockopt(socket, SOL_SOCKET, SO_GET_FILTER, nullptr, &instructions), 0);
  return instructions;
}

std::vector<int> watches_of_this_process() {
  std::vector<int> found;
  for (const auto& entry : hal::linux_backend::entries("/proc/self/fd")) {
    const int descriptor = std::atoi(entry.filename().c_str());
    int protocol = 0;
    socklen_t size = sizeof protocol;
    if (::getsockopt(descriptor, SOL_SOCKET, SO_PROTOCOL, &protocol, &size) == 0 &&
        protocol == NETLINK_KOBJECT_UEVENT)
      found.push_back(descriptor);
  }
  return found;
}

TEST(MediaEvents, are_all_that_libcamera_hears_and_others_hear_what_they_asked_for) {
  if (hal::linux_backend::udev_is_at_work())
    GTEST_SKIP() << "udev is at work, until when libcamera is not started; run it again";
  const Context context{udev_new(), &udev_unref};
  ASSERT_NE(context, nullptr);
  const Watch media = watch(context, {"media"});
  const Watch both = watch(context, {"media", "video4linux"});
  ASSERT_TRUE(media && both);
  const socklen_t of_one = filter_length(udev_monitor_get_fd(media.get()));
  EXPECT_GT(filter_length(udev_monitor_get_fd(both.get())), of_one);

  const std::vector<int> ours = watches_of_this_process();
  const auto session = hal::linux_backend::LibcameraSession::start();
  ASSERT_TRUE(session) << session.error().message;
  (*session)->cameras();
  int libcameras = 0;
  for (const int descriptor : watches_of_this_process())
    if (std::ranges::find(ours, descriptor) == ours.end()) {
      ++libcameras;
      EXPECT_EQ(filter_length(descriptor), of_one) << "it hears of video nodes, too";
    }
  EXPECT_EQ(libcameras, 1) << "libcamera has no watch over devices here, or more than one";
}

} // namespace
} // namespace octascope::tests
