#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "pipeline/volume/flow_scale.h"

namespace octascope::pipeline {
namespace {

TEST(FlowScale, keeps_what_cannot_be_told_apart_from_what_is_static) {
  EXPECT_EQ(quantise_flow(std::numeric_limits<float>::quiet_NaN()), flow_untold);
  EXPECT_EQ(quantise_flow(0), flow_static);
  EXPECT_EQ(quantise_flow(-1), flow_static);
  EXPECT_EQ(quantise_flow(1), flow_full);
  EXPECT_EQ(quantise_flow(2), flow_full);
  EXPECT_TRUE(std::isnan(flow_of(flow_untold)));
}

TEST(FlowScale, returns_what_was_quantised_within_half_a_count) {
  for (int i = 0; i <= 1000; ++i) {
    const float flow = static_cast<float>(i) / 1000;
    EXPECT_NEAR(flow_of(quantise_flow(flow)), flow, 0.5F / 254 + 1e-6F);
  }
}

} // namespace
} // namespace octascope::pipeline
