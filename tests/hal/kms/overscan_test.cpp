#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "hal/linux/kms/mode/overscan.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {
namespace {

using namespace hal::linux_backend::kms;

TEST(Overscan, of_nothing_is_the_whole_screen) {
  EXPECT_EQ(visible_part(1920, 1080, {}).value(), (Rectangle{0, 0, 1920, 1080}));
}

TEST(Overscan, is_in_per_cent_of_either_side) {
  EXPECT_EQ(visible_part(1000, 500, {10, 5, 20, 2}).value(), (Rectangle{100, 100, 850, 390}));
}

TEST(Overscan, keeps_the_part_on_the_screen) {
  std::mt19937_64 random{3};
  for (int i = 0; i < 20000; ++i) {
    const int width = std::uniform_int_distribution{1, 8192}(random);
    const int height = std::uniform_int_distribution{1, 4320}(random);
    std::uniform_real_distribution margin{0.0, 25.0};
    const Overscan overscan{margin(random), margin(random), margin(random), margin(random)};
    const auto part = visible_part(width, height, overscan);
    ASSERT_TRUE(part);
    ASSERT_GE(part->x, 0);
    ASSERT_GE(part->y, 0);
    ASSERT_GE(part->width, 1);
    ASSERT_GE(part->height, 1);
    ASSERT_LE(part->x + part->width, width);
    ASSERT_LE(part->y + part->height, height);
    ASSERT_NEAR(part->width, width * (100 - overscan.left - overscan.right) / 100, 1.01);
  }
}

TEST(Overscan, that_makes_no_sense_is_refused) {
  for (const double margin :
       {-0.1, 25.1, 1e300, std::nan(""), std::numeric_limits<double>::infinity()})
    for (const Overscan& overscan : {Overscan{margin, 0, 0, 0}, Overscan{0, margin, 0, 0},
                                     Overscan{0, 0, margin, 0}, Overscan{0, 0, 0, margin}}) {
      EXPECT_THAT(visible_part(100, 100, overscan),
                  FailsWith(hal::ErrorCode::invalid_argument, "expected 0 to 25"));
    }
}

} // namespace
} // namespace octascope::tests
