#include <string>

#include <gtest/gtest.h>

#include "pipeline/faults/fault_log.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint t0{100s};

TEST(FaultLog, gathers_faults_of_one_kind_in_one_record) {
  FaultLog log;
  log.add("camera", "lost", "the first", t0);
  log.add("camera", "lost", "the second", t0 + 1s, 10);
  log.add("camera", "broken", "another kind", t0 + 2s);
  log.add("trigger", "lost", "another device", t0 + 3s, 2);
  const auto records = log.records();
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[0].message, "the first");
  EXPECT_EQ(records[0].count, 11U);
  EXPECT_EQ(records[0].first, t0);
  EXPECT_EQ(records[0].last, t0 + 1s);
  EXPECT_EQ(records[1].kind, "broken");
  EXPECT_EQ(records[1].count, 1U);
  EXPECT_EQ(records[2].device, "trigger");
  EXPECT_EQ(records[2].count, 2U);
}

TEST(FaultLog, words_are_made_for_the_first_of_a_kind_alone) {
  FaultLog log;
  int made = 0;
  for (int i = 0; i < 3; ++i)
    log.add(
        "camera", "lost", [&] { return "made " + std::to_string(++made); }, t0 + i * 1s, 2);
  EXPECT_EQ(made, 1);
  ASSERT_EQ(log.records().size(), 1U);
  EXPECT_EQ(log.records()[0].message, "made 1");
  EXPECT_EQ(log.records()[0].count, 6U);
  EXPECT_EQ(log.records()[0].last, t0 + 2s);
}

} // namespace
} // namespace octascope::pipeline
