#include <string>

#include <gtest/gtest.h>

#include "pipeline/faults/fault_log.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint t0{100s};

TEST(FaultLog, gathers_faults_of_one_kind_in_one_record) {
  FaultLog log;
  log.add(Fault::saturation, "the first", t0);
  log.add(Fault::saturation, "the second", t0 + 1s, 10);
  log.add(Fault::overrun, "another kind", t0 + 2s);
  const hal::Error gone{hal::ErrorCode::disconnected, "a device's answer"};
  log.add(Device::galvo_trigger, gone, t0 + 3s);
  log.add(Device::line_camera, gone, t0 + 4s);
  log.add(Device::galvo_trigger, gone, t0 + 5s);
  const auto records = log.records();
  ASSERT_EQ(records.size(), 4U) << "in the order in which they came";
  EXPECT_EQ(records[0].kind, Fault::saturation);
  EXPECT_EQ(records[0].message, "the first");
  EXPECT_EQ(records[0].count, 11U);
  EXPECT_EQ(records[0].first, t0);
  EXPECT_EQ(records[0].last, t0 + 1s);
  EXPECT_EQ(records[1].kind, Fault::overrun);
  EXPECT_EQ(records[1].count, 1U);
  EXPECT_EQ(records[2].kind, fault_of(Device::galvo_trigger, hal::ErrorCode::disconnected));
  EXPECT_EQ(records[2].message, "a device's answer");
  EXPECT_EQ(records[2].count, 2U);
  EXPECT_EQ(records[3].kind, fault_of(Device::line_camera, hal::ErrorCode::disconnected));
}

TEST(FaultLog, words_are_made_for_the_first_of_a_kind_alone) {
  FaultLog log;
  int made = 0;
  for (int i = 0; i < 3; ++i)
    log.add(
        Fault::late_frame, [&] { return "made " + std::to_string(++made); }, t0 + i * 1s, 2);
  EXPECT_EQ(made, 1);
  ASSERT_EQ(log.records().size(), 1U);
  EXPECT_EQ(log.records()[0].message, "made 1");
  EXPECT_EQ(log.records()[0].count, 6U);
  EXPECT_EQ(log.records()[0].last, t0 + 2s);
}

} // namespace
} // namespace octascope::pipeline
