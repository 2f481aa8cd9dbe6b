#include <gtest/gtest.h>

#include "pipeline/scan/scan_plan.h"

namespace octascope::pipeline {
namespace {

TEST(ScanPlan, defaults_are_the_papers) {
  const ScanPlan plan;
  ASSERT_TRUE(plan.validate());
  EXPECT_EQ(plan.lines_per_frame(), 379);
  EXPECT_NEAR(hal::to_ms(plan.sweep_duration()), 141.0, 0.1);
  EXPECT_EQ(plan.geometry().voxels(), 512U * 300U * 80U);
}

TEST(ScanPlan, there_and_back_gains_what_the_fly_back_cost) {
  const ScanPlan one_way;
  ScanPlan plan;
  plan.bidirectional = true;
  EXPECT_EQ(plan.lines_per_frame(), 308);
  EXPECT_EQ(plan.converted_lines(), 308);
  EXPECT_EQ(one_way.converted_lines(), 300);
  EXPECT_GE(plan.volumes_per_s(), 1.2 * one_way.volumes_per_s());
  EXPECT_EQ(plan.geometry(), one_way.geometry());
  EXPECT_FALSE(plan.runs_backwards(0));
  EXPECT_TRUE(plan.runs_backwards(79));
  EXPECT_FALSE(one_way.runs_backwards(79));
}

TEST(ScanPlan, repeats_cost_their_number_in_volume_rate) {
  const ScanPlan once;
  ScanPlan plan;
  plan.repeats = 3;
  EXPECT_EQ(plan.sweeps(), 240);
  EXPECT_EQ(plan.b_scan_of(0), 0);
  EXPECT_EQ(plan.b_scan_of(239), 79);
  EXPECT_NEAR(plan.volumes_per_s(), once.volumes_per_s() / 3, 1e-6);
  EXPECT_EQ(plan.geometry(), once.geometry());
  plan.repeats = 5;
  EXPECT_EQ(plan.validate().error().message, "scan plan: repeats is 5, expected 1 to 4");
}

TEST(ScanPlan, names_what_is_wrong) {
  ScanPlan plan;
  plan.b_scans = 0;
  const auto result = plan.validate();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, hal::ErrorCode::invalid_argument);
  EXPECT_EQ(result.error().message, "scan plan: b_scans is 0, expected 1 to 65536");
}

} // namespace
} // namespace octascope::pipeline
