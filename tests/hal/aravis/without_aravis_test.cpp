// The program that was built without Aravis says so.
#include <gmock/gmock.h>

#include "hal/linux/aravis/genicam_camera.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {
namespace {

TEST(WithoutAravis, a_camera_is_refused_with_the_remedy) {
  hal::linux_backend::MonotonicClock clock;
  const auto camera = hal::linux_backend::make_genicam_camera({}, clock);
  const auto opened = camera->open({});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, hal::ErrorCode::unsupported);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("apt install libaravis-dev"));
  EXPECT_EQ(camera->state(), hal::DeviceState::absent);
  EXPECT_THAT(hal::linux_backend::find_genicam_camera({}), FailsWith(hal::ErrorCode::unsupported));
}

} // namespace
} // namespace octascope::tests
