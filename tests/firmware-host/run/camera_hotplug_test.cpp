#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "firmware-host/run/camera_hotplug.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using firmware_host::CameraHotplug;

bool soon_is(const auto& condition) {
  const auto deadline = std::chrono::steady_clock::now() + 5s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline)
      return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

// Between the program's look at the devices and the twin's start.
TEST(CameraHotplug, that_came_meanwhile_is_found_without_an_event) {
  const CameraHotplug late{[] { return true; }};
  EXPECT_TRUE(soon_is([&] { return late.came(); }));
}

TEST(CameraHotplug, is_not_looked_for_again_and_again) {
  std::atomic<int> looks{0};
  {
    const CameraHotplug late{[&] {
      ++looks;
      return false;
    }};
    EXPECT_TRUE(soon_is([&] { return looks == 1; }));
    std::this_thread::sleep_for(500ms);
    EXPECT_FALSE(late.came());
  }
  EXPECT_EQ(looks, 1);
}

} // namespace
} // namespace octascope::tests
