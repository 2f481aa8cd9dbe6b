// The soak's judgement: it must see what it is there to see.
#include <algorithm>
#include <filesystem>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/soak/soak_verdict.h"
#include "tests/soak/stolen_time.h"
#include "tests/support/devices/random_faults.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using namespace std::chrono_literals;

std::vector<ProcessSample> steady(double first_kib, double last_kib) {
  std::vector<ProcessSample> samples;
  for (int i = 0; i <= 100; ++i)
    samples.push_back({i * 1.0, first_kib + (last_kib - first_kib) * i / 100, 20, 10});
  return samples;
}

std::vector<std::string> judge(const std::vector<ProcessSample>& samples) {
  return complaints_about_growth(held_between(samples, 0, 10), held_between(samples, 90, 101));
}

TEST(SoakVerdict, sees_memory_that_grows_and_not_noise) {
  EXPECT_TRUE(judge(steady(500000, 500000)).empty());
  EXPECT_TRUE(judge(steady(500000, 504000)).empty());
  EXPECT_TRUE(judge(steady(500000, 400000)).empty());
  ASSERT_EQ(judge(steady(500000, 507000)).size(), 1U);
  EXPECT_THAT(judge(steady(500000, 507000))[0], HasSubstr("resident memory grew"));
}

TEST(SoakVerdict, sees_one_descriptor_and_one_thread) {
  std::vector<ProcessSample> samples = steady(1000, 1000);
  samples.back().descriptors += 1;
  ASSERT_EQ(judge(samples).size(), 1U);
  EXPECT_THAT(judge(samples)[0], HasSubstr("descriptors grew from 20 to 21"));
  samples[95].threads += 2;
  EXPECT_EQ(judge(samples).size(), 2U);
}

TEST(SoakVerdict, does_not_judge_a_run_that_was_cut_short) {
  std::vector<ProcessSample> samples = steady(1000, 1000);
  samples.resize(50);
  EXPECT_EQ(judge(samples).size(), 1U);
}

json report() {
  return {{"volumes",
           {{"planned", 22},
            {"acquired", 15},
            {"published", 15},
            {"displayed", 12},
            {"skipped", 2},
            {"passed_over", 2},
            {"lost", 1},
            {"unfinished", 1}}},
          {"lost", {{"volumes", 4}}}};
}

TEST(SoakVerdict, sees_volumes_that_are_missing_from_the_books) {
  EXPECT_TRUE(complaints_about_volumes(report(), 4).empty());
  EXPECT_EQ(complaints_about_volumes(report(), 3).size(), 1U) << "lost, and not explained";
  for (const char* key :
       {"planned", "acquired", "displayed", "skipped", "passed_over", "lost", "unfinished"}) {
    json wrong = report();
    wrong["volumes"][key] = wrong["volumes"][key].get<int>() + 1;
    EXPECT_EQ(complaints_about_volumes(wrong, 4).size(), 1U) << key;
  }
}

TEST(ProcessSample, counts_what_this_process_holds) {
  const auto before = sample_process(::getpid());
  ASSERT_TRUE(before);
  const int opened = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  std::vector<char> held(64 << 20, 'x');
  const auto after = sample_process(::getpid());
  ::close(opened);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->descriptors, before->descriptors + 1);
  EXPECT_GE(after->threads, 1U);
  EXPECT_GT(after->resident_kib, before->resident_kib + 60 * 1024);
  EXPECT_FALSE(sample_process(0));
}

TEST(StolenTime, is_the_eighth_column_of_all_processors) {
  EXPECT_EQ(stolen_ticks("cpu  100 200 300 4000 5000 60 7 890 11 12\ncpu0 1 1\n"), 890);
  EXPECT_FALSE(stolen_ticks(""));
  EXPECT_FALSE(stolen_ticks("cpu 1 2 3\ncpu0 1 2 3 4 5 6 7 8\n"));
  EXPECT_FALSE(stolen_ticks("intr 1 2 3 4 5 6 7 8\n"));
}

TEST(RandomFaults, are_scripts_within_their_time_and_the_same_for_a_seed) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    const std::string text = random_faults(seed, 10, 60, 1);
    const auto script = sim::FaultScript::parse(text, "random");
    ASSERT_TRUE(script) << script.error().message << text;
    EXPECT_GT(script->faults.size(), 10U);
    for (const sim::ScriptedFault& fault : script->faults) {
      EXPECT_GE(fault.at, 10s);
      EXPECT_LE(fault.at + fault.duration, 60s + 10ms);
    }
    EXPECT_EQ(text, random_faults(seed, 10, 60, 1));
  }
}

// A value that scripts refuse came up once in 2700 of them.
TEST(RandomFaults, are_never_refused) {
  for (unsigned seed = 0; seed < 4000; ++seed) {
    const auto script = sim::FaultScript::parse(random_faults(seed, 0, 10, 0.3), "random");
    ASSERT_TRUE(script) << script.error().message << " with seed " << seed;
  }
}

TEST(RandomFaults, are_rehearsed_each_once) {
  const Rehearsal rehearsal = every_fault_once(7, 3);
  const auto script = sim::FaultScript::parse(rehearsal.script, "rehearsal");
  ASSERT_TRUE(script) << script.error().message;
  EXPECT_EQ(script->faults.size(), sim::scriptable_faults().size() - 1 + rehearsed_display_losses);
  EXPECT_GE(hal::from_seconds(rehearsal.until_s),
            script->faults.back().at + script->faults.back().duration);
}

TEST(RandomFaults, explain_no_more_than_whole_volumes) {
  const auto lost = [](std::string_view text) {
    return most_volumes_lost(*sim::FaultScript::parse(text, "text"), 100ms);
  };
  EXPECT_EQ(lost(""), 0);
  EXPECT_EQ(lost("[[fault]]\ndevice = \"display\"\nkind = \"lost\"\nat_s = 1\nduration_s = 9\n"),
            0);
  EXPECT_EQ(lost("[[fault]]\ndevice = \"galvo_trigger\"\nkind = \"missed_pulses\"\nat_s = 1\n"
                 "duration_s = 1\n"),
            12);
}

} // namespace
} // namespace octascope::tests
