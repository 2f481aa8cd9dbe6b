// The commands that tell: devices, doctor, help and version.
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "ui/view/action_table.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::vector<std::string> all_devices{"line_camera", "galvo_trigger", "control_input",
                                           "scope_camera", "display"};

TEST(Devices, says_what_is_there_and_what_would_serve) {
  const ProgramResult result = run_well({"devices"});
  EXPECT_EQ(result.err, "");
  for (const std::string& device : all_devices)
    EXPECT_THAT(result.out, HasSubstr(device));
}

TEST(Devices, as_json) {
  const ProgramResult result = run_well({"devices", "--json"});
  const json told = json::parse(result.out);
  for (const char* kind : {"video", "gpio", "hid", "displays"})
    EXPECT_TRUE(told.at("found").at(kind).is_array()) << kind;
  for (const std::string& device : all_devices) {
    EXPECT_NE(told.at("used").at(device).at("backend"), "") << device;
    EXPECT_NE(told.at("used").at(device).at("reason"), "") << device;
  }
}

// Nobody is there to plug a device in.
TEST(DevicesLearn, ends_with_its_input) {
  const ProgramResult result = run_octascope({"devices", "--learn"}, std::chrono::seconds{60});
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.err, HasSubstr("octascope devices --learn: the input has ended"));
  EXPECT_THAT(result.err, HasSubstr("--device"));
}

TEST(DevicesLearn, is_given_up_by_enter) {
  std::vector<std::string> words{"sh", "-c", "echo | \"$@\"", "sh"};
  for (auto& word : octascope_command({"devices", "--learn"}))
    words.push_back(std::move(word));
  const ProgramResult result = run_program(std::move(words));
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.out, HasSubstr("Enter gives up"));
  EXPECT_THAT(result.err, HasSubstr("given up before a device was plugged in"));
}

TEST(Doctor, looks_at_everything_and_says_how_to_mend_it) {
  const ProgramResult result = run_octascope({"doctor", "--json"});
  ASSERT_TRUE(result.exit_status == 0 || result.exit_status == 1) << result.describe();
  const json told = json::parse(result.out);
  std::set<std::string> subjects;
  bool fails = false;
  for (const json& check : told.at("checks")) {
    subjects.insert(check.at("subject"));
    const std::string verdict = check.at("verdict");
    EXPECT_TRUE(verdict == "good" || verdict == "limited" || verdict == "fails") << verdict;
    EXPECT_NE(check.at("found"), "") << check;
    EXPECT_EQ(check.at("mend") == "", verdict == "good") << check;
    fails = fails || verdict == "fails";
  }
  EXPECT_THAT(subjects,
              testing::IsSupersetOf({"processor", "memory", "real-time priority", "locked memory",
                                     "clock", "disk", "graphics", "devices", "reconstruction",
                                     "udev", "udev rules", "drivers"}));
  EXPECT_EQ(result.exit_status, fails ? 1 : 0);
}

TEST(Doctor, speaks_to_people) {
  const ProgramResult result = run_octascope({"doctor"});
  ASSERT_TRUE(result.exit_status == 0 || result.exit_status == 1) << result.describe();
  EXPECT_THAT(result.out, HasSubstr("real-time priority"));
}

TEST(Version, is_a_number) {
  const ProgramResult result = run_well({"--version"});
  EXPECT_THAT(result.out, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

class Help : public testing::TestWithParam<std::string> {};

TEST_P(Help, has_an_example) {
  std::vector<std::string> arguments{"--help"};
  if (!GetParam().empty())
    arguments.insert(arguments.begin(), GetParam());
  const ProgramResult result = run_well(arguments);
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("Example"));
  EXPECT_THAT(result.out, HasSubstr("octascope " + GetParam()));
}

TEST(RunHelp, says_what_each_key_does) {
  const ProgramResult result = run_octascope({"run", "--help"});
  for (const ui::ActionRow& row : ui::action_table())
    if (row.keys[0].key != 0) {
      EXPECT_THAT(result.out, HasSubstr(" " + std::string{row.label} + "\n"));
    }
}

INSTANTIATE_TEST_SUITE_P(Commands, Help,
                         testing::Values("", "run", "devices", "doctor", "reconstruct", "render",
                                         "record", "capture", "commission", "info", "export",
                                         "replay", "vessels"),
                         [](const auto& test) {
                           return test.param.empty() ? std::string{"octascope"} : test.param;
                         });

} // namespace
} // namespace octascope::tests
