#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/faults/fault_script.h"
#include "tests/support/fails_with.h"
#include "tests/support/program/built_places.h"

namespace octascope::sim {
namespace {

using namespace std::chrono_literals;

TEST(FaultScript, reads_every_parameter) {
  const auto script = FaultScript::parse("[[fault]]\ndevice = \"line_camera\"\n"
                                         "kind = \"late_frames\"\nat_s = 1.5\nduration_s = 2\n"
                                         "count = 3\nrepeat_s = 4\nevery = 5\nprobability = 0.25\n"
                                         "seed = 6\nlate_ms = 7.5\n"
                                         "[[fault]]\ndevice = \"control_input\"\n"
                                         "kind = \"stuck_switch\"\nat_s = 0\nduration_s = 1\n"
                                         "switch = 2\npressed = false\n",
                                         "test.toml");
  ASSERT_TRUE(script) << script.error().message;
  ASSERT_EQ(script->faults.size(), 2U);
  const ScriptedFault& late = script->faults[0];
  EXPECT_EQ(late.kind, pipeline::Fault::late_frame);
  EXPECT_EQ(late.at, 1500ms);
  EXPECT_EQ(late.duration, 2s);
  EXPECT_EQ(late.count, 3U);
  EXPECT_EQ(late.repeat, 4s);
  EXPECT_EQ(late.every, 5);
  EXPECT_EQ(late.probability, 0.25);
  EXPECT_EQ(late.seed, 6U);
  EXPECT_EQ(late.late_by, 7500us);
  EXPECT_EQ(describe(late), "line_camera late_frames at 1.5 s for 2 s 3 times every 4 s");
  EXPECT_EQ(script->faults[1].switch_index, 2);
  EXPECT_FALSE(script->faults[1].stuck_pressed);
}

TEST(FaultScript, an_empty_file_is_a_day_without_faults) {
  EXPECT_TRUE(FaultScript::parse("", "test.toml")->faults.empty());
}

TEST(FaultScript, refuses_what_makes_no_sense) {
  const std::string camera = "[[fault]]\ndevice = \"line_camera\"\nat_s = 1\n";
  const std::vector<std::pair<std::string, std::string>> refused{
      {"[[fault]]\nkind = \"unplug\"\nat_s = 1\nduration_s = 1",
       "bad.toml:1: [fault] device is missing"},
      {"[[fault]]\ndevice = \"toaster\"\nkind = \"unplug\"\nat_s = 1",
       "device is 'toaster', expected one of \"line_camera\""},
      {camera + "kind = \"bounce\"\nduration_s = 1",
       "kind is 'bounce', expected for the line_camera one of \"unplug\", "},
      {camera + "kind = \"unplug\"", "duration_s is missing"},
      {camera + "kind = \"dropped_frames\"", "has no end"},
      {camera + "kind = \"unplug\"\nduration_s = 2\nrepeat_s = 2",
       "repeat_s is 2, expected more than duration_s, 2"},
      {camera + "kind = \"unplug\"\nduration_s = -1", "duration_s is -1"},
      {camera + "kind = \"unplug\"\nduration_s = 1\nlate_ms = 3", "unknown key \"late_ms\""},
      {camera + "kind = \"unplug\"\nduration_s = 1\ncount = 3", "unknown key \"count\""},
      {camera + "kind = \"wrong_size\"\ncount = 1\nsize_share = 1", "size_share is 1"},
      {camera + "kind = \"dropped_frames\"\ncount = 1\nprobability = 1.5", "probability is 1.5"},
      {"fault = 3", "fault is 3"},
      {"[[fualt]]\n", "unknown key \"fualt\""}};
  for (const auto& [text, told] : refused)
    EXPECT_THAT(FaultScript::parse(text, "bad.toml"), tests::FailsSaying(told)) << text;
}

TEST(FaultScript, the_samples_load_and_cover_every_kind_of_every_device) {
  std::set<pipeline::Fault> covered;
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator{tests::source_folder() / "sim/faults/examples"}) {
    const auto script = FaultScript::load(entry.path());
    ASSERT_TRUE(script) << script.error().message;
    EXPECT_FALSE(script->faults.empty()) << entry.path();
    for (const ScriptedFault& fault : script->faults)
      covered.insert(fault.kind);
    ++files;
  }
  EXPECT_GT(files, 0);
  for (const ScriptableFault& scriptable : scriptable_faults())
    EXPECT_TRUE(covered.contains(scriptable.fault))
        << facts_of(scriptable.fault).device_key() << " " << scriptable.kind;
}

} // namespace
} // namespace octascope::sim
