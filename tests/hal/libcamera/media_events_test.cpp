// Which of the process's watches over devices video nodes are kept from.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <libudev.h>

#include "hal/linux/libcamera/media_events.h"

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

// A table that grows takes a new key for its hashes, and later tables take that one.
void have_libudev_change_its_hashes(const Context& context) {
  std::vector<std::string> many;
  for (int i = 0; i < 64; ++i)
    many.push_back("subsystem" + std::to_string(i));
  ASSERT_NE(watch(context, many), nullptr);
}

TEST(MediaEvents, video_nodes_are_kept_from_each_watch_in_whatever_order_its_filter_is) {
  const Context context{udev_new(), &udev_unref};
  ASSERT_NE(context, nullptr);
  constexpr int count = 24;
  std::vector<Watch> like_libcameras;
  for (int i = 0; i < count; ++i) {
    have_libudev_change_its_hashes(context);
    like_libcameras.push_back(watch(context, {"media", "video4linux"}));
    ASSERT_NE(like_libcameras.back(), nullptr);
  }
  const Watch other = watch(context, {"media", "hidraw"});
  ASSERT_NE(other, nullptr);
  const auto changed = hal::linux_backend::keep_video_nodes_from_libcamera();
  ASSERT_TRUE(changed) << changed.error().message;
  EXPECT_EQ(*changed, count);
  const auto again = hal::linux_backend::keep_video_nodes_from_libcamera();
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, 0) << "they hear of media devices alone already";
}

} // namespace
} // namespace octascope::tests
