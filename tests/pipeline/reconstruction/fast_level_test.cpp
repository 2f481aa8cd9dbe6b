#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/reconstruction/fused/fast_level.h"

namespace octascope::pipeline {
namespace {

TEST(FastLevel, decibels_are_within_two_thousandths) {
  double worst = 0;
  for (float power = 1e-12F; power < 1e12F; power *= 1.00003F)
    worst = std::max(worst, std::abs(static_cast<double>(fast_power_db(power)) -
                                     10 * std::log10(static_cast<double>(power))));
  EXPECT_LE(worst, 0.002);
  EXPECT_GT(worst, 0.0001); // it is an approximation: the test must be able to see it
}

TEST(FastLevel, never_falls_where_power_rises) {
  float before = fast_power_db(0.5F);
  for (float power = 0.5F; power < 8.0F; power = std::nextafter(power * 1.0000005F, 9.0F)) {
    const float level = fast_power_db(power);
    ASSERT_GE(level, before - 1e-5F) << power;
    before = level;
  }
}

TEST(FastLevel, darkness_is_finite) {
  EXPECT_LT(fast_power_db(0.0F), -370);
  EXPECT_TRUE(std::isfinite(fast_power_db(0.0F)));
  EXPECT_EQ(fast_quantise_level(fast_power_db(0.0F)), 0);
}

TEST(FastLevel, quantises_as_the_level_scale_says) {
  for (float db = -200; db < 200; db += 0.013F)
    ASSERT_EQ(fast_quantise_level(db), quantise_level(db)) << db;
}

} // namespace
} // namespace octascope::pipeline
