#include <gtest/gtest.h>

#include "pipeline/scan_plan.h"

namespace octascope::pipeline {
namespace {

TEST(ScanPlan, defaults_are_the_papers) {
  const ScanPlan plan;
  ASSERT_TRUE(plan.validate());
  EXPECT_EQ(plan.lines_per_frame(), 379);
  EXPECT_NEAR(hal::to_ms(plan.sweep_duration()), 141.0, 0.1);
  EXPECT_EQ(plan.geometry().voxels(), 512U * 300U * 80U);
}

TEST(ScanPlan, names_what_is_wrong) {
  ScanPlan plan;
  plan.b_scans = 0;
  const auto result = plan.validate();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().fault, hal::Fault::invalid_argument);
  EXPECT_EQ(result.error().message, "scan plan: b_scans is 0, expected 1 to 65536");
}

} // namespace
} // namespace octascope::pipeline
