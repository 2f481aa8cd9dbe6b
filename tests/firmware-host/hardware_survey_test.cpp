#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "firmware-host/device_choice.h"
#include "firmware-host/hardware_survey.h"
#include "tests/support/scratch_folder.h"

namespace octascope::firmware_host {
namespace {

// A folder that looks like /sys, as far as the survey looks.
class FakeSystem {
public:
  void add(const std::string& folder, const std::string& file, const std::string& text) {
    std::filesystem::create_directories(folder_ / folder);
    folder_.write(folder + "/" + file, text);
  }
  HardwareSurvey survey() const { return survey_hardware(folder_.path()); }

private:
  tests::ScratchFolder folder_;
};

TEST(HardwareSurvey, of_an_empty_machine_finds_nothing) {
  const HardwareSurvey survey = FakeSystem{}.survey();
  EXPECT_TRUE(survey.video.empty());
  EXPECT_TRUE(survey.gpio.empty());
  EXPECT_TRUE(survey.hid.empty());
  EXPECT_TRUE(survey.displays.empty());
}

TEST(HardwareSurvey, finds_devices_in_the_order_of_their_names) {
  FakeSystem system;
  system.add("sys/class/video4linux/video1", "name", "Scope camera\n");
  system.add("sys/class/video4linux/video0", "name", "Line camera\n");
  system.add("sys/class/video4linux/v4l-subdev0", "name", "not a camera\n");
  system.add("sys/bus/gpio/devices/gpiochip0", "uevent", "DRIVER=x\nOF_FULLNAME=/soc/gpio@7e20\n");
  system.add("sys/class/hidraw/hidraw0/device", "uevent",
             "HID_ID=0003\nHID_NAME=Three-switch pedal\nHID_NAMES=no\n");
  system.add("sys/class/drm/card0", "dev", "226:0\n");
  system.add("sys/class/drm/card0-HDMI-A-1", "status", "connected\n");
  system.add("sys/class/drm/card0-DP-1", "status", "disconnected\n");
  const HardwareSurvey survey = system.survey();
  ASSERT_EQ(survey.video.size(), 2U);
  EXPECT_EQ(survey.video[0].node, "/dev/video0");
  EXPECT_EQ(survey.video[0].name, "Line camera");
  EXPECT_EQ(survey.video[1].name, "Scope camera");
  ASSERT_EQ(survey.gpio.size(), 1U);
  EXPECT_EQ(survey.gpio[0].node, "/dev/gpiochip0");
  EXPECT_EQ(survey.gpio[0].name, "/soc/gpio@7e20");
  ASSERT_EQ(survey.hid.size(), 1U);
  EXPECT_EQ(survey.hid[0].node, "/dev/hidraw0");
  EXPECT_EQ(survey.hid[0].name, "Three-switch pedal");
  ASSERT_EQ(survey.displays.size(), 2U) << "the card itself is no connector";
  EXPECT_EQ(survey.displays[0].node, "card0-DP-1");
  EXPECT_EQ(survey.displays[0].name, "disconnected");
  EXPECT_EQ(survey.displays[1].name, "connected");
}

TEST(HardwareSurvey, a_window_system_is_known_by_the_environment) {
  unsetenv("WAYLAND_DISPLAY");
  unsetenv("DISPLAY");
  EXPECT_FALSE(FakeSystem{}.survey().has_window_system);
  setenv("WAYLAND_DISPLAY", "wayland-0", 1);
  EXPECT_TRUE(FakeSystem{}.survey().has_window_system);
  unsetenv("WAYLAND_DISPLAY");
  setenv("DISPLAY", ":0", 1);
  EXPECT_TRUE(FakeSystem{}.survey().has_window_system);
  unsetenv("DISPLAY");
}

TEST(DeviceChoice, without_devices_the_twins_serve) {
  const DeviceChoices choices = choose_devices({}, {});
  for (const DeviceChoice& choice : choices.all())
    EXPECT_FALSE(choice.reason.empty()) << choice.device;
  EXPECT_EQ(choices.line_camera.backend, "sim");
  EXPECT_EQ(choices.galvo_trigger.backend, "sim");
  EXPECT_EQ(choices.control_input.backend, "sim");
  EXPECT_EQ(choices.scope_camera.backend, "sim");
  EXPECT_EQ(choices.display.backend, "offscreen");
}

TEST(DeviceChoice, says_what_is_plugged_in_and_does_not_serve) {
  HardwareSurvey survey;
  survey.video = {{"/dev/video0", "Line camera"}};
  const DeviceChoices choices = choose_devices(survey, {});
  EXPECT_EQ(choices.line_camera.backend, "sim");
  EXPECT_NE(choices.line_camera.reason.find("/dev/video0 Line camera"), std::string::npos);
  RunOptions asked;
  asked.simulate = true;
  EXPECT_EQ(choose_devices(survey, asked).line_camera.reason.find("/dev/video0"),
            std::string::npos);
}

TEST(DeviceChoice, a_recording_stands_in_for_the_line_camera) {
  RunOptions options;
  options.recording = RecordingOptions{"s.raw", {1, 2, 3}};
  EXPECT_EQ(choose_devices({}, options).line_camera.backend, "recording");
}

TEST(DeviceChoice, the_display_follows_the_wish_or_else_the_machine) {
  HardwareSurvey with_window_system;
  with_window_system.has_window_system = true;
  EXPECT_EQ(choose_devices(with_window_system, {}).display.backend, "window");
  const auto wished = [&](DisplayChoice wish) {
    RunOptions options;
    options.display = wish;
    return choose_devices(with_window_system, options).display.backend;
  };
  EXPECT_EQ(wished(DisplayChoice::offscreen), "offscreen");
  EXPECT_EQ(wished(DisplayChoice::window), "window");
  EXPECT_EQ(wished(DisplayChoice::kms), "kms");
}

} // namespace
} // namespace octascope::firmware_host
