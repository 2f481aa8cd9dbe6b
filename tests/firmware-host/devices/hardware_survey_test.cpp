#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/devices/hardware_survey.h"
#include "tests/firmware-host/support/fake_machine.h"

namespace octascope::firmware_host {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using tests::FakeMachine;

TEST(HardwareSurvey, of_an_empty_machine_finds_nothing) {
  const HardwareSurvey survey = FakeMachine{}.survey();
  EXPECT_TRUE(survey.video.empty());
  EXPECT_TRUE(survey.gpio.empty());
  EXPECT_TRUE(survey.hid.empty());
  EXPECT_TRUE(survey.displays.empty());
  EXPECT_FALSE(survey.machine.udev_runs);
  EXPECT_FALSE(survey.machine.rules_installed);
}

TEST(HardwareSurvey, finds_devices_in_the_order_of_their_numbers) {
  FakeMachine machine;
  machine.add_camera("video10", "Third camera");
  machine.add_camera("video1", "Scope camera");
  machine.add_camera("video0", "Line camera");
  machine.add("sys/class/video4linux/v4l-subdev0/name", "not a camera\n");
  machine.add("sys/bus/media/devices/media0/model", "uvcvideo board\n");
  machine.add_node("/dev/media0");
  machine.add("sys/bus/gpio/devices/gpiochip0/uevent", "DRIVER=x\nOF_FULLNAME=/soc/gpio@7e20\n");
  machine.add_node("/dev/gpiochip0");
  machine.add_pedal("hidraw0", "Three-switch pedal");
  machine.add("sys/class/input/event3/device/name", "Griffin PowerMate\n");
  machine.add("sys/class/input/event3/device/id/vendor", "077d\n");
  machine.add("sys/class/input/event3/device/id/product", "0410\n");
  machine.add_node("/dev/input/event3");
  machine.add("sys/class/drm/renderD128/dev", "226:128\n");
  machine.add_node("/dev/dri/renderD128");
  machine.add("sys/class/drm/card0/dev", "226:0\n");
  machine.add_node("/dev/dri/card0");
  machine.add_connector("card0-HDMI-A-1", "connected", "1920x1080\n1280x720\n");
  machine.add_connector("card0-DP-1", "disconnected");
  const HardwareSurvey survey = machine.survey();

  ASSERT_EQ(survey.video.size(), 3U);
  EXPECT_EQ(survey.video[0].node, "/dev/video0");
  EXPECT_EQ(survey.video[0].name, "Line camera");
  EXPECT_EQ(survey.video[1].name, "Scope camera");
  EXPECT_EQ(survey.video[2].name, "Third camera");
  ASSERT_EQ(survey.media.size(), 1U);
  EXPECT_EQ(survey.media[0].name, "uvcvideo board");
  ASSERT_EQ(survey.gpio.size(), 1U);
  EXPECT_EQ(survey.gpio[0].node, "/dev/gpiochip0");
  EXPECT_EQ(survey.gpio[0].name, "/soc/gpio@7e20");
  ASSERT_EQ(survey.hid.size(), 1U);
  EXPECT_EQ(survey.hid[0].node, "/dev/hidraw0");
  EXPECT_EQ(survey.hid[0].name, "Three-switch pedal");
  EXPECT_THAT(survey.hid[0].facts, ElementsAre(Pair("product", "05f3:00ff")));
  ASSERT_EQ(survey.input.size(), 1U);
  EXPECT_EQ(survey.input[0].node, "/dev/input/event3");
  EXPECT_THAT(survey.input[0].facts, ElementsAre(Pair("product", "077d:0410")));
  ASSERT_EQ(survey.render.size(), 1U);
  ASSERT_EQ(survey.displays.size(), 2U) << "the card itself is no connector";
  EXPECT_EQ(survey.displays[0].node, "card0-DP-1");
  EXPECT_EQ(survey.displays[0].name, "disconnected");
  EXPECT_EQ(survey.displays[1].name, "connected");
  for (const auto* list : {&survey.video, &survey.media, &survey.gpio, &survey.hid, &survey.render})
    for (const FoundDevice& device : *list)
      EXPECT_TRUE(device.usable) << device.node << ": " << device.why_not;
}

TEST(HardwareSurvey, a_node_that_is_refused_says_which_group_to_join) {
  FakeMachine machine;
  machine.add_camera("video0", "Camera", true);
  const std::string group = machine.give_to_a_group("/dev/video0");
  ASSERT_NE(group, "root");
  const FoundDevice stranger = machine.survey().video.at(0);
  EXPECT_FALSE(stranger.usable);
  EXPECT_THAT(stranger.why_not, HasSubstr("not in its group " + group));
  EXPECT_THAT(stranger.remedy, HasSubstr("sudo usermod -aG " + group + " $USER"));

  const FoundDevice joined = machine.survey({}, {group}).video.at(0);
  EXPECT_THAT(joined.why_not, HasSubstr("after logging in"));
  EXPECT_THAT(joined.remedy, HasSubstr("log out and in again"));

  const FoundDevice member = machine.survey({group}, {group}).video.at(0);
  EXPECT_THAT(member.remedy, HasSubstr("getfacl /dev/video0"));
}

TEST(HardwareSurvey, a_node_for_root_alone_wants_our_udev_rules) {
  FakeMachine machine;
  machine.add_pedal("hidraw0", "Pedal", true, 0600);
  const FoundDevice pedal = machine.survey().hid.at(0);
  EXPECT_FALSE(pedal.usable);
  EXPECT_THAT(pedal.why_not, HasSubstr("only root"));
  EXPECT_THAT(pedal.remedy, HasSubstr("deploy/70-octascope.rules"));
}

TEST(HardwareSurvey, a_device_without_a_node_wants_udevd) {
  FakeMachine machine;
  machine.add("sys/class/video4linux/video0/name", "Camera\n");
  const FoundDevice camera = machine.survey().video.at(0);
  EXPECT_FALSE(camera.usable);
  EXPECT_THAT(camera.why_not, HasSubstr("/dev/video0 is not there"));
  EXPECT_THAT(camera.remedy, HasSubstr("systemctl start systemd-udevd"));
}

TEST(HardwareSurvey, names_the_programs_that_have_a_device_open) {
  FakeMachine machine;
  machine.add_camera("video0", "Camera");
  machine.add_camera("video1", "Other");
  machine.add("proc/812/comm", "pipewire\n");
  machine.link("proc/812/fd/7", "/dev/video0");
  machine.link("proc/812/fd/8", "/dev/video0");
  machine.link("proc/812/fd/9", "/tmp/file");
  machine.add("proc/99/comm", "cheese\n");
  machine.link("proc/99/fd/3", "/dev/video0");
  machine.add("proc/meminfo");
  const HardwareSurvey survey = machine.survey();
  EXPECT_THAT(survey.video.at(0).held_by, HasSubstr("pipewire (812)"));
  EXPECT_THAT(survey.video.at(0).held_by, HasSubstr("cheese (99)"));
  EXPECT_EQ(survey.video.at(0).held_by.size(), std::string{"pipewire (812), cheese (99)"}.size());
  EXPECT_EQ(survey.video.at(1).held_by, "");
}

// VESA E-EDID 1.4, base block: header, one descriptor with the tag of a monitor's name, checksum.
std::string edid_of(const std::string& name) {
  std::string bytes(128, '\0');
  bytes.replace(0, 8, std::string{"\x00\xFF\xFF\xFF\xFF\xFF\xFF\x00", 8});
  bytes.replace(54, 5, std::string{"\0\0\0\xFC\0", 5});
  bytes.replace(59, 13, (name + "\n            ").substr(0, 13));
  unsigned sum = 0;
  for (const char byte : bytes)
    sum += static_cast<unsigned char>(byte);
  bytes[127] = static_cast<char>(256 - sum % 256);
  return bytes;
}

TEST(HardwareSurvey, a_display_tells_monitor_and_mode_and_what_is_in_the_way) {
  FakeMachine machine;
  machine.add_node("/dev/dri/card0");
  machine.add_connector("card0-HDMI-A-1", "connected", "3840x2160\n1920x1080\n");
  machine.add("sys/class/drm/card0-HDMI-A-1/edid", edid_of("OR MONITOR"));
  machine.add_connector("card0-HDMI-A-2", "connected");
  machine.add_connector("card0-HDMI-A-3", "disconnected");
  machine.add_connector("card0-Virtual-1", "unknown");
  machine.add_connector("card0-Writeback-1", "unknown");
  machine.add_connector("card1-DP-1", "connected", "800x600\n");
  const HardwareSurvey survey = machine.survey();
  ASSERT_EQ(survey.displays.size(), 5U) << "a writeback connector shows nothing";
  EXPECT_TRUE(survey.displays[0].usable);
  EXPECT_THAT(survey.displays[0].facts,
              ElementsAre(Pair("monitor", "OR MONITOR"), Pair("mode", "3840x2160"),
                          Pair("lit", "enabled"), Pair("card", "/dev/dri/card0")));
  EXPECT_THAT(survey.displays[1].why_not, HasSubstr("no mode"));
  EXPECT_THAT(survey.displays[1].remedy, HasSubstr("[devices] mode"));
  EXPECT_THAT(survey.displays[2].why_not, HasSubstr("no monitor is plugged in"));
  EXPECT_TRUE(survey.displays[3].usable) << "nobody knows until it is tried";
  EXPECT_THAT(survey.displays[4].why_not, HasSubstr("/dev/dri/card1")) << "no such node";
}

TEST(HardwareSurvey, tells_what_the_machine_lacks) {
  FakeMachine machine;
  machine.make_healthy();
  machine.add("sys/bus/usb/devices/1-2:1.0/bInterfaceClass", "0e\n");
  machine.add("sys/bus/usb/devices/1-2:1.0/bInterfaceSubClass", "01\n");
  machine.add("sys/bus/usb/devices/1-3:1.0/bInterfaceClass", "03\n");
  machine.link("sys/bus/usb/devices/1-3:1.0/driver", "../../drivers/usbhid");
  machine.add("sys/bus/usb/drivers/usbhid/bind");
  machine.add("sys/bus/usb/devices/drivers/usbhid/bind"); // where the link leads
  machine.add("sys/bus/pci/devices/0000:00:02.0/class", "0x030000\n");
  const MachineFacts facts = machine.survey().machine;
  EXPECT_TRUE(facts.udev_runs);
  EXPECT_TRUE(facts.rules_installed);
  EXPECT_TRUE(facts.has_graphics_card);
  EXPECT_FALSE(facts.has_graphics_driver);
  ASSERT_FALSE(facts.without_driver.empty());
  EXPECT_EQ(facts.without_driver.front(), "USB camera 1-2:1.0");
}

TEST(HardwareSurvey, of_this_machine_ends_well) {
  const HardwareSurvey survey = survey_hardware();
  for (const auto* list : {&survey.video, &survey.gpio, &survey.hid, &survey.render})
    for (const FoundDevice& device : *list)
      EXPECT_EQ(device.usable, device.why_not.empty()) << device.node;
}

TEST(HardwareSurvey, a_window_system_is_known_by_the_environment) {
  unsetenv("WAYLAND_DISPLAY");
  unsetenv("DISPLAY");
  EXPECT_FALSE(FakeMachine{}.survey().has_window_system);
  setenv("WAYLAND_DISPLAY", "wayland-0", 1);
  EXPECT_TRUE(FakeMachine{}.survey().has_window_system);
  unsetenv("WAYLAND_DISPLAY");
  setenv("DISPLAY", ":0", 1);
  EXPECT_TRUE(FakeMachine{}.survey().has_window_system);
  unsetenv("DISPLAY");
}

} // namespace
} // namespace octascope::firmware_host
