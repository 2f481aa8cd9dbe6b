#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/devices/calibrated_camera.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// A camera that is whatever the test plugs in.
class NamedCamera final : public hal::LineCamera {
public:
  std::string plugged_in;

private:
  std::string_view do_backend() const override { return "named"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open(const hal::LineCameraConfig&) override { return {}; }
  hal::Result<> do_start() override { return {}; }
  hal::Result<std::optional<hal::LineFrame>> do_wait_frame(hal::Duration) override {
    return std::nullopt;
  }
  void do_release(int) override {}
  void do_stop() override {}
  void do_close() override {}
  std::string do_identity() const override { return plugged_in; }
};

class CalibratedCameraTest : public testing::Test {
protected:
  CameraVerdict look(const std::string& plugged_in) {
    line_camera.plugged_in = plugged_in;
    camera.look(line_camera, now += 1s);
    return camera.verdict();
  }

  hal::TimePoint now{100s};
  pipeline::FaultLog faults;
  NamedCamera line_camera;
  CalibratedCamera camera{"Octoplus, serial 1", faults};
};

TEST(CompareCameras, knows_nothing_where_nobody_says) {
  EXPECT_EQ(compare_cameras("", "a"), CameraVerdict::unknown);
  EXPECT_EQ(compare_cameras("a", ""), CameraVerdict::unknown);
  EXPECT_EQ(compare_cameras("a", "a"), CameraVerdict::same);
  EXPECT_EQ(compare_cameras("a", "b"), CameraVerdict::another);
}

TEST_F(CalibratedCameraTest, another_one_is_told_for_as_long_as_it_is_there) {
  EXPECT_EQ(look(""), CameraVerdict::unknown) << "none was opened yet";
  EXPECT_EQ(look("Octoplus, serial 1"), CameraVerdict::same);
  EXPECT_TRUE(faults.records().empty());
  for (int turn = 0; turn < 100; ++turn)
    EXPECT_EQ(look("Octoplus, serial 2"), CameraVerdict::another);
  ASSERT_EQ(faults.records().size(), 1U);
  EXPECT_EQ(faults.records()[0].kind, pipeline::Fault::another_camera);
  EXPECT_EQ(faults.records()[0].count, 1U) << "once";
  EXPECT_THAT(faults.records()[0].message, HasSubstr("\"Octoplus, serial 1\""));
  EXPECT_THAT(faults.records()[0].message, HasSubstr("\"Octoplus, serial 2\""));
  EXPECT_EQ(look("Octoplus, serial 1"), CameraVerdict::same) << "the right one is back";
  EXPECT_EQ(look("Octoplus, serial 3"), CameraVerdict::another);
  EXPECT_EQ(faults.records()[0].count, 2U);
}

TEST(CalibratedCameraWithout, a_name_is_never_another_one) {
  pipeline::FaultLog faults;
  CalibratedCamera camera{"", faults};
  NamedCamera line_camera;
  line_camera.plugged_in = "Octoplus, serial 2";
  camera.look(line_camera, hal::TimePoint{1s});
  EXPECT_EQ(camera.verdict(), CameraVerdict::unknown);
  EXPECT_TRUE(faults.records().empty());
  EXPECT_THAT(words_on_unnamed_camera("c.toml"), HasSubstr("c.toml names no camera"));
}

} // namespace
} // namespace octascope::firmware_host
