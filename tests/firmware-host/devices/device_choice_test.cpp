#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/devices/device_choice.h"

namespace octascope::firmware_host {
namespace {

using testing::ElementsAre;

DetectedDevices everything() {
  return {.line_camera = {true, "/dev/video20 grabber, Y12"},
          .galvo_trigger = {true, "gpiochip0 line 4, octascope-trigger"},
          .control_input = {true, "VEC Infinity pedal"},
          .scope_camera = {true, "microscope camera"},
          .console_display = {true, "card0 HDMI-A-1"}};
}

// Line camera, trigger, controls, scope camera, display.
std::vector<std::string_view> backends(const DeviceChoices& c) {
  return {c.line_camera.backend, c.galvo_trigger.backend, c.control_input.backend,
          c.scope_camera.backend, c.display.backend};
}

RunOptions simulate() {
  RunOptions options;
  options.simulate = true;
  return options;
}

TEST(DeviceChoice, without_devices_the_twins_serve) {
  DetectedDevices nothing;
  nothing.line_camera.what = "no video node";
  nothing.console_display.what = "no connector";
  nothing.control_input.what = "no pedal";
  const DeviceChoices choices = choose_devices(nothing, {});
  for (const DeviceChoice& choice : choices.all())
    EXPECT_FALSE(choice.reason.empty()) << facts_of(choice.device).key;
  EXPECT_THAT(backends(choices), ElementsAre("sim", "sim", "sim", "sim", "offscreen"));
  EXPECT_NE(choices.line_camera.reason.find("no video node"), std::string::npos);
}

TEST(DeviceChoice, what_is_plugged_in_serves_without_being_asked) {
  const DeviceChoices choices = choose_devices(everything(), {});
  EXPECT_THAT(backends(choices), ElementsAre("v4l2", "gpio", "hid", "libcamera", "kms"));
  EXPECT_NE(choices.line_camera.reason.find("/dev/video20"), std::string::npos);
}

TEST(DeviceChoice, twins_that_were_asked_for_serve_in_spite_of_what_is_plugged_in) {
  const DeviceChoices choices = choose_devices(everything(), simulate());
  EXPECT_THAT(backends(choices), ElementsAre("sim", "sim", "sim", "sim", "kms"))
      << "a display shows twins as well";
  EXPECT_EQ(choices.line_camera.reason.find("/dev/video20"), std::string::npos);
}

TEST(DeviceChoice, a_replay_has_display_and_pedal_and_nothing_that_scans) {
  RunOptions options;
  options.replay = ReplayOptions{.file = "eye.h5"};
  const DeviceChoices choices = choose_devices(everything(), options);
  for (const DeviceChoice& choice :
       {choices.line_camera, choices.galvo_trigger, choices.scope_camera})
    EXPECT_EQ(choice.backend, "none") << facts_of(choice.device).key;
  EXPECT_EQ(choices.control_input.backend, "hid");
  EXPECT_EQ(choices.display.backend, "kms");
}

TEST(DeviceChoice, no_twin_stands_beside_a_patients_spectra) {
  DetectedDevices only_camera;
  only_camera.line_camera = {true, "/dev/video0"};
  const DeviceChoices choices = choose_devices(only_camera, {});
  EXPECT_EQ(choices.galvo_trigger.backend, "gpio") << "waited for";
  EXPECT_EQ(choices.control_input.backend, "hid") << "waited for";
  EXPECT_EQ(choices.scope_camera.backend, "none");
  DeviceConfig config;
  config.scope_camera = "sim";
  EXPECT_EQ(choose_devices(only_camera, {}, config).scope_camera.backend, "none");
}

TEST(DeviceChoice, no_real_line_is_pulsed_for_a_simulated_camera) {
  DetectedDevices no_camera = everything();
  no_camera.line_camera.usable = false;
  const DeviceChoices choices = choose_devices(no_camera, {});
  EXPECT_EQ(choices.galvo_trigger.backend, "sim");
  EXPECT_EQ(choices.scope_camera.backend, "sim");
  EXPECT_EQ(choices.control_input.backend, "hid") << "a pedal serves with either";
}

TEST(DeviceChoice, a_device_that_the_configuration_names_is_waited_for) {
  DeviceConfig config;
  config.line_camera = "/dev/video7";
  config.scope_camera = "libcamera";
  const DeviceChoices choices = choose_devices({}, {}, config);
  EXPECT_EQ(choices.line_camera.backend, "v4l2");
  EXPECT_NE(choices.line_camera.reason.find("/dev/video7"), std::string::npos);
  EXPECT_EQ(choices.scope_camera.backend, "libcamera");
}

TEST(DeviceChoice, a_genicam_camera_is_taken_where_it_is_named_and_nowhere_else) {
  DeviceConfig config;
  for (const char* name : {"usb3vision", "usb3vision:0123", "gigevision:192.168.1.20"}) {
    config.line_camera = name;
    const DeviceChoices choices = choose_devices(everything(), {}, config);
    EXPECT_THAT(backends(choices), ElementsAre("aravis", "gpio", "hid", "libcamera", "kms"))
        << name;
    EXPECT_NE(choices.line_camera.reason.find(name), std::string::npos);
  }
}

TEST(DeviceChoice, no_scanner_is_pulsed_for_a_camera_on_the_loopback) {
  DeviceConfig config;
  config.line_camera = "gigevision:127.0.0.1";
  const DeviceChoices choices = choose_devices(everything(), {}, config);
  EXPECT_THAT(backends(choices), ElementsAre("aravis", "sim", "hid", "none", "kms"));
  EXPECT_EQ(choose_devices(everything(), simulate(), config).line_camera.backend, "sim");
}

TEST(DeviceChoice, a_camera_may_come_where_its_twin_serves_for_want_of_it_alone) {
  const DetectedDevices nothing;
  const auto may_come = [](const DetectedDevices& found, const RunOptions& options,
                           const DeviceConfig& config = {}) {
    return camera_may_come(choose_devices(found, options, config), options, config);
  };
  EXPECT_TRUE(may_come(nothing, {}));
  EXPECT_FALSE(may_come(everything(), {})) << "it is there";
  EXPECT_FALSE(may_come(nothing, simulate())) << "the twin was asked for";
  DeviceConfig twin;
  twin.line_camera = DeviceConfig::twin;
  EXPECT_FALSE(may_come(nothing, {}, twin)) << "likewise";
  RunOptions recorded;
  recorded.recording = RecordingOptions{"s.raw", {1, 2, 3}};
  EXPECT_FALSE(may_come(nothing, recorded));
}

TEST(DeviceChoice, a_recording_stands_in_for_the_line_camera) {
  RunOptions options;
  options.recording = RecordingOptions{"s.raw", {1, 2, 3}};
  const DeviceChoices choices = choose_devices(everything(), options);
  EXPECT_EQ(choices.line_camera.backend, "recording");
  EXPECT_EQ(choices.galvo_trigger.backend, "sim");
  EXPECT_EQ(choices.scope_camera.backend, "none");
}

TEST(DeviceChoice, the_display_follows_the_configuration_or_else_the_machine) {
  DetectedDevices detected = everything();
  EXPECT_EQ(choose_devices(detected, {}).display.backend, "kms");
  detected.has_window_system = true;
  EXPECT_EQ(choose_devices(detected, {}).display.backend, "window");
  const auto wanted = [&](DisplayChoice choice) {
    RunOptions options;
    options.display = choice;
    return choose_devices(detected, options).display.backend;
  };
  EXPECT_EQ(wanted(DisplayChoice::offscreen), "offscreen");
  EXPECT_EQ(wanted(DisplayChoice::window), "window");
  EXPECT_EQ(wanted(DisplayChoice::kms), "kms");
}

} // namespace
} // namespace octascope::firmware_host
