// What the survey is made into for people: the checks of `doctor` and the words of `devices`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "firmware-host/diagnosis/device_text.h"
#include "firmware-host/diagnosis/hardware_checks.h"
#include "tests/firmware-host/support/fake_machine.h"

namespace octascope::firmware_host {
namespace {

using testing::HasSubstr;
using testing::Not;
using tests::FakeMachine;

HealthCheck check_of(const HardwareSurvey& survey, const std::string& subject) {
  for (const HealthCheck& check : check_hardware(survey))
    if (check.subject == subject)
      return check;
  ADD_FAILURE() << "nothing is said of " << subject;
  return {};
}

void expect_mend(const HardwareSurvey& survey, const char* subject, const char* found,
                 const char* fix) {
  const HealthCheck check = check_of(survey, subject);
  EXPECT_EQ(check.verdict, Verdict::limited) << subject;
  EXPECT_THAT(check.found, HasSubstr(found));
  EXPECT_THAT(check.remedy, HasSubstr(fix));
}

TEST(HardwareChecks, of_a_healthy_machine_are_all_good_and_ask_for_nothing) {
  FakeMachine machine;
  machine.make_healthy();
  machine.add_camera("video0", "Line camera");
  machine.add_pedal("hidraw0", "Pedal");
  machine.add_node("/dev/dri/card0");
  machine.add_connector("card0-HDMI-A-1", "connected", "1920x1080\n");
  const HardwareSurvey survey = machine.survey();
  for (const HealthCheck& check : check_hardware(survey)) {
    EXPECT_EQ(check.verdict, Verdict::good) << check.subject << ": " << check.found;
    EXPECT_EQ(check.remedy, "") << check.subject;
    EXPECT_NE(check.found, "") << check.subject;
  }
  EXPECT_THAT(check_of(survey, "display").found, HasSubstr("1920x1080"));
}

TEST(HardwareChecks, nothing_is_said_of_what_is_not_plugged_in) {
  FakeMachine machine;
  machine.make_healthy();
  for (const HealthCheck& check : check_hardware(machine.survey()))
    EXPECT_THAT(check.subject, testing::AnyOf("udev", "udev rules", "drivers"));
}

TEST(HardwareChecks, without_udevd_and_rules_say_how_to_get_them) {
  FakeMachine machine;
  machine.add_pedal("hidraw0", "Pedal", true, 0600);
  const HardwareSurvey survey = machine.survey();
  expect_mend(survey, "udev", "does not run", "systemctl start systemd-udevd");
  expect_mend(survey, "udev rules", "for root alone", "sudo cp deploy/70-octascope.rules");
  expect_mend(survey, "pedals and knobs", "/dev/hidraw0 (Pedal)", "70-octascope.rules");
}

TEST(HardwareChecks, missing_drivers_say_which_module_to_load) {
  HardwareSurvey survey;
  survey.machine.without_driver = {"USB camera 1-2:1.0", "USB HID device 1-3:1.0"};
  expect_mend(survey, "drivers", "USB camera 1-2:1.0", "modprobe uvcvideo");
  survey.machine.without_driver = {"USB HID device 1-3:1.0"};
  expect_mend(survey, "drivers", "USB HID device", "modprobe usbhid");
  survey.machine.without_driver.clear();
  survey.machine.has_graphics_card = true;
  survey.machine.has_graphics_driver = false;
  expect_mend(survey, "drivers", "graphics card", "firmware");
}

TEST(HardwareChecks, a_camera_that_is_refused_or_held_says_by_whom) {
  HardwareSurvey survey;
  survey.video = {{.node = "/dev/video0", .name = "A"},
                  {.node = "/dev/video1",
                   .name = "B",
                   .usable = false,
                   .why_not = "this user is not in its group video",
                   .remedy = "sudo usermod -aG video $USER, then log out and in again"}};
  expect_mend(survey, "cameras", "1 of 2 cannot be used; /dev/video1 (B)", "usermod -aG video");
  survey.video[0].held_by = "cheese (99)";
  expect_mend(survey, "other programs", "/dev/video0 (A) is open in cheese (99)",
              "sudo fuser -k /dev/video0");
}

TEST(HardwareChecks, a_display_that_cannot_show_says_why) {
  FakeMachine machine;
  machine.make_healthy();
  machine.add_node("/dev/dri/card0");
  machine.add_connector("card0-HDMI-A-1", "disconnected");
  expect_mend(machine.survey(), "display", "card0-HDMI-A-1: no monitor", "check cable");
  machine.add_connector("card0-DP-1", "connected");
  expect_mend(machine.survey(), "display", "card0-DP-1: the monitor tells no mode", "cable");
}

class DeviceWords : public testing::Test {
protected:
  void SetUp() override {
    machine_.make_healthy();
    machine_.add_camera("video0", "Line camera");
    machine_.add_pedal("hidraw0", "Pedal", true, 0600);
    machine_.add("proc/99/comm", "cheese\n");
    machine_.link("proc/99/fd/3", "/dev/video0");
    choices_.line_camera = {pipeline::Device::line_camera, "v4l2", "/dev/video0 suits"};
  }
  FakeMachine machine_;
  DeviceChoices choices_;
};

TEST_F(DeviceWords, tell_each_device_what_is_in_its_way_and_the_mend) {
  const std::string text = devices_text(machine_.survey(), choices_);
  EXPECT_THAT(text, HasSubstr("/dev/video0      Line camera\n"));
  EXPECT_THAT(text, HasSubstr("open in cheese (99)"));
  EXPECT_THAT(text, HasSubstr("/dev/hidraw0     Pedal, product 05f3:00ff\n"));
  EXPECT_THAT(text, HasSubstr("not usable: only root may open it"));
  EXPECT_THAT(text, HasSubstr("→ sudo cp deploy/70-octascope.rules"));
  EXPECT_THAT(text, HasSubstr("GPIO chips (galvo trigger)\n    none\n"));
  EXPECT_THAT(text, HasSubstr("line_camera    v4l2       /dev/video0 suits\n"));
}

TEST_F(DeviceWords, as_json_keep_node_and_name_and_add_the_rest) {
  const auto json = nlohmann::json::parse(devices_json(machine_.survey(), choices_));
  const auto& camera = json.at("found").at("video").at(0);
  EXPECT_EQ(camera.at("node"), "/dev/video0");
  EXPECT_EQ(camera.at("name"), "Line camera");
  EXPECT_EQ(camera.at("usable"), true);
  EXPECT_EQ(camera.at("held_by"), "cheese (99)");
  EXPECT_FALSE(camera.contains("why_not"));
  const auto& pedal = json.at("found").at("hid").at(0);
  EXPECT_EQ(pedal.at("product"), "05f3:00ff");
  EXPECT_EQ(pedal.at("usable"), false);
  EXPECT_NE(pedal.at("mend"), "");
  EXPECT_TRUE(json.at("found").at("displays").empty());
  EXPECT_EQ(json.at("machine").at("udev_runs"), true);
  EXPECT_EQ(json.at("machine").at("udev_rules_installed"), true);
  EXPECT_EQ(json.at("used").at("line_camera").at("backend"), "v4l2");
}

TEST_F(DeviceWords, of_a_device_without_driver_send_to_the_doctor) {
  HardwareSurvey survey = machine_.survey();
  EXPECT_THAT(devices_text(survey, choices_), Not(HasSubstr("no driver holds it")));
  survey.machine.without_driver = {"USB camera 1-2:1.0"};
  EXPECT_THAT(devices_text(survey, choices_), HasSubstr("USB camera 1-2:1.0: plugged in, but no"));
}

} // namespace
} // namespace octascope::firmware_host
