#include <gtest/gtest.h>

#include "firmware-host/configuration/control_device_file.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/must.h"
#include "ui/controls/control_profile.h"

namespace octascope::firmware_host {
namespace {

using hal::linux_backend::ControlModel;
using hal::linux_backend::HidFamily;

ControlModel by_bits() {
  return {.vendor = 0x1234,
          .product = 0x00ff,
          .model = "learned",
          .name = "A \"pedal\" \\ of sorts",
          .family = HidFamily::mapped,
          .switches = 2,
          .bits = {{1, 0x04}, {0, 0x80}},
          .report_id = std::uint8_t{3}};
}
ControlModel by_keys() {
  return {.vendor = 0xabcd,
          .product = 1,
          .model = "learned",
          .name = "typing",
          .family = HidFamily::keyboard,
          .switches = 1,
          .keys = {48}};
}

TEST(ControlDeviceFile, what_is_written_is_read_again) {
  for (const ControlModel& model : {by_bits(), by_keys()}) {
    const auto read = tests::must(parse_control_device(control_device_text(model), "name"));
    EXPECT_EQ(read, model);
  }
}

TEST(ControlDeviceFile, the_first_profile_is_a_profile_for_it) {
  for (const ControlModel& model : {by_bits(), by_keys()}) {
    const auto profile = tests::must(ui::ControlProfile::parse(first_profile_text(model), "name"));
    EXPECT_EQ(profile.usb,
              (std::vector<std::string>{hal::linux_backend::usb_id(model.vendor, model.product)}));
    EXPECT_TRUE(profile.reaches(ui::Action::freeze));
    EXPECT_TRUE(profile.reaches(ui::Action::next_parameter));
  }
}

TEST(ControlDeviceFile, refuses_what_contradicts_itself) {
  const std::string head = "usb = \"1234:5678\"\n";
  for (const std::string& text :
       {std::string{"usb = \"1234\"\n[[switch]]\nkey = 3\n"}, head, head + "[[switch]]\nbyte = 1\n",
        head + "[[switch]]\nkey = 3\nbyte = 1\nmask = 1\n",
        head + "[[switch]]\nkey = 3\n[[switch]]\nbyte = 1\nmask = 1\n",
        head + "[[switch]]\nkey = 0\n", head + "[[switch]]\nbyte = 1\nmask = 256\n",
        head + "lamp = 1\n[[switch]]\nkey = 3\n"}) {
    const auto read = parse_control_device(text, "name");
    ASSERT_FALSE(read) << text;
    EXPECT_TRUE(read.error().message.starts_with("name:")) << read.error().message;
  }
}

TEST(ControlDeviceFile, mutated_files_are_read_or_refused) {
  std::mt19937_64 generator{tests::fresh_seed()};
  int refused = 0;
  for (int round = 0; round < 5000; ++round) {
    const auto read =
        parse_control_device(tests::mutate(control_device_text(by_bits()), generator), "name");
    if (!read) {
      ++refused;
      ASSERT_TRUE(read.error().message.starts_with("name:")) << read.error().message;
      continue;
    }
    ASSERT_GE(read->switches, 1);
    ASSERT_LE(read->switches, hal::linux_backend::most_switches);
    ASSERT_EQ(read->bits.empty(), !read->keys.empty());
  }
  EXPECT_GT(refused, 250);
  EXPECT_LT(refused, 5000);
}

} // namespace
} // namespace octascope::firmware_host
