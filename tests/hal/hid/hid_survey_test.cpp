#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hal/linux/hid/models/control_model.h"
#include "hal/linux/hid/survey/hid_survey.h"
#include "tests/hal/hid/fake_hidapi.h"
#include "tests/support/files/mutation.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/program/built_places.h"

namespace octascope::hal::linux_backend {
namespace {

namespace fs = std::filesystem;

// A folder like /sys, and what hidapi lists.
class HidSurveyTest : public testing::Test {
protected:
  void write(const std::string& file, std::string_view text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream{root_ / file} << text;
  }
  void hidraw(int n, std::uint16_t vendor, std::uint16_t product, std::string_view name,
              std::string_view phys) {
    hidapi_.plug(fmt::format("/dev/hidraw{}", n), vendor, product);
    write(fmt::format("sys/class/hidraw/hidraw{}/device/uevent", n),
          fmt::format("DRIVER=hid-generic\nHID_NAME={}\nHID_PHYS={}\n\nno key\n", name, phys));
  }
  void event(int n, std::string_view vendor, std::string_view product, std::string_view name,
             std::string_view phys) const {
    const std::string folder = fmt::format("sys/class/input/event{}/device/", n);
    write(folder + "id/vendor", vendor);
    write(folder + "id/product", product);
    write(folder + "name", name);
    write(folder + "phys", phys);
  }
  std::vector<PluggedControl> known() const {
    return known_controls(survey_hid(root_.path()), listed_control_models());
  }

  tests::ScratchFolder root_;
  tests::FakeHidapi hidapi_;
};

TEST_F(HidSurveyTest, reads_what_the_kernel_lists) {
  hidraw(10, 0x05f3, 0x00ff, "VEC  VEC USB Footpedal", "usb-1/input0");
  hidraw(2, 0x045e, 0x091b, "Surface Dial", "");
  event(3, "077d", "0410", "Griffin PowerMate", "usb-2/input0");
  write("sys/class/input/mouse0/name", "not an event node");
  EXPECT_EQ(survey_hid(root_.path()),
            (std::vector<HidNode>{
                {"/dev/hidraw2", false, 0x045e, 0x091b, "Surface Dial", "/dev/hidraw2"},
                {"/dev/hidraw10", false, 0x05f3, 0x00ff, "VEC  VEC USB Footpedal", "usb-1"},
                {"/dev/input/event3", true, 0x077d, 0x0410, "Griffin PowerMate", "usb-2"}}));
}

TEST_F(HidSurveyTest, files_that_say_nothing_are_devices_that_nobody_knows) {
  hidapi_.plug("/dev/hidraw0", 0, 0);
  hidapi_.plug("/dev/hidraw1", 0, 0);
  write("sys/class/hidraw/hidraw0/device/uevent", "HID_NAME\n=\n");
  write("sys/class/input/event0/nothing", "");
  EXPECT_EQ(survey_hid(root_.path()).size(), 3U);
  EXPECT_TRUE(known().empty());
  EXPECT_EQ(survey_hid(root_.path() / "nowhere").size(), 2U) << "no input devices";
}

TEST_F(HidSurveyTest, pedals_lead_whatever_the_order_of_plugging) {
  hidraw(0, 0x046d, 0xc626, "SpaceNavigator", "usb-1/input0");
  event(0, "077d", "0410", "Griffin PowerMate", "usb-2/input0");
  hidraw(1, 0x05f3, 0x00ff, "VEC", "usb-3/input0");
  hidraw(2, 0x1234, 0x5678, "Somebody's keyboard", "usb-4/input0");
  const auto plugged = known();
  ASSERT_EQ(plugged.size(), 3U);
  EXPECT_EQ(plugged[0].model.model, "vec_infinity");
  EXPECT_EQ(plugged[1].model.model, "powermate");
  EXPECT_EQ(plugged[2].model.model, "space_mouse");
}

TEST_F(HidSurveyTest, nodes_of_one_device_are_one_control) {
  event(0, "1a86", "e026", "FootSwitch", "usb-1/input0");
  event(1, "1a86", "e026", "FootSwitch Mouse", "usb-1/input1");
  event(2, "1a86", "e026", "FootSwitch", "usb-2/input0");
  hidraw(0, 0x1a86, 0xe026, "FootSwitch", "usb-1/input0"); // not the way it is read
  const auto plugged = known();
  ASSERT_EQ(plugged.size(), 2U);
  EXPECT_EQ(plugged[0].nodes.size(), 2U);
  EXPECT_EQ(plugged[1].nodes.size(), 1U);
}

TEST_F(HidSurveyTest, the_name_tells_three_switches_from_one) {
  event(0, "3553", "b001", "PCsensor FootSwitch3-F1.8", "usb-1/input0");
  event(1, "3553", "b001", "PCsensor FootSwitch", "usb-2/input0");
  const auto plugged = known();
  ASSERT_EQ(plugged.size(), 2U);
  EXPECT_EQ(plugged[0].model.model, "pcsensor_triple");
  EXPECT_EQ(plugged[1].model.model, "pcsensor_single");
}

TEST(ControlModels, fit_the_board) {
  for (const ControlModel& model : listed_control_models()) {
    EXPECT_LE(model.switches, most_switches);
    EXPECT_TRUE(model.keys.empty() || std::cmp_equal(model.keys.size(), model.switches));
    EXPECT_FALSE(model.name.empty());
  }
}

// The kernel names a HID device bus:vendor:product.number, whatever its bus is.
std::string udev_rule(const ControlModel& model) {
  if (model.by_evdev())
    return fmt::format("SUBSYSTEM==\"input\", KERNEL==\"event*\", ATTRS{{id/vendor}}==\"{:04x}\", "
                       "ATTRS{{id/product}}==\"{:04x}\", GROUP=\"input\", MODE=\"0660\", "
                       "TAG+=\"uaccess\"\n",
                       model.vendor, model.product);
  return fmt::format("SUBSYSTEM==\"hidraw\", KERNELS==\"*:{:04X}:{:04X}.*\", GROUP=\"input\", "
                     "MODE=\"0660\", TAG+=\"uaccess\"\n",
                     model.vendor, model.product);
}

// A rule for each control that is listed, in the list's order, and the trigger's.
TEST(UdevRules, in_deploy_are_those_of_the_list) {
  std::string rules;
  std::set<std::string> written; // models of one vendor and product share a rule
  for (const ControlModel& model : listed_control_models())
    if (const std::string rule = udev_rule(model); written.insert(rule).second)
      rules += fmt::format("\n# {}\n{}", model.name, rule);
  rules += "\n# galvo trigger\nSUBSYSTEM==\"gpio\", KERNEL==\"gpiochip*\", GROUP=\"gpio\", "
           "MODE=\"0660\"\n";
  const std::string file = tests::whole_file(tests::source_folder() / "deploy/70-octascope.rules");
  EXPECT_EQ(file.substr(file.find("\n\n") + 1), rules); // after the head, which is comments
}

} // namespace
} // namespace octascope::hal::linux_backend
