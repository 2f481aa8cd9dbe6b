#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/v4l2/camera_settings.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

TEST(CameraSettings, values_go_to_the_nearest_step) {
  const SettingRange range{.name = "Gain", .least = -10, .most = 95, .step = 20, .settable = true};
  for (const auto& [wanted, expected] :
       {std::pair{-10, -10}, {-1, -10}, {1, 10}, {9, 10}, {10, 10}, {69, 70}, {95, 90}})
    EXPECT_EQ(fit_setting(range, wanted).value(), expected) << wanted;
}

TEST(CameraSettings, outside_of_the_range_both_are_said) {
  const SettingRange range{.name = "Gain", .least = 0, .most = 255, .step = 1, .settable = true};
  const auto refused = fit_setting(range, 256);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "control \"Gain\" is configured to be 256, expected 0 to 255");
  EXPECT_FALSE(fit_setting(range, -1));
  SettingRange fixed = range;
  fixed.settable = false;
  EXPECT_EQ(fit_setting(fixed, 3).error().code, ErrorCode::unsupported);
}

TEST(CameraSettings, whatever_a_driver_says_of_its_range_the_value_is_within) {
  std::mt19937_64 random{tests::fresh_seed()};
  const auto any = [&] {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    constexpr std::int64_t awkward[] = {0, 1, -1, most, -most, -most - 1, INT32_MAX, INT32_MIN};
    return random() % 2 == 0 ? awkward[random() % std::size(awkward)]
                             : static_cast<std::int64_t>(random()) >> random() % 64;
  };
  for (int i = 0; i < 100'000; ++i) {
    const SettingRange range{"x", any(), any(), any(), true};
    const std::int64_t wanted = any();
    const auto fitted = fit_setting(range, wanted);
    ASSERT_EQ(fitted.has_value(), wanted >= range.least && wanted <= range.most);
    if (fitted) {
      ASSERT_GE(*fitted, range.least);
      ASSERT_LE(*fitted, range.most);
    }
    const auto blanking = blanking_for(std::exp2(static_cast<double>(random() % 400) / 10), any(),
                                       static_cast<int>(any()), range);
    if (blanking) {
      ASSERT_GE(*blanking, range.least);
      ASSERT_LE(*blanking, range.most);
    }
  }
}

TEST(CameraSettings, blanking_makes_the_line_rate) {
  const SettingRange range{"Horizontal Blanking", 100, 100'000, 1, true};
  // 300 MHz, lines of 1024 pixels: 215 kHz leaves 371 pixels of blanking.
  EXPECT_EQ(blanking_for(215e3, 300'000'000, 1024, range).value(), 371);
  EXPECT_THAT(blanking_for(300e3, 300'000'000, 1024, range),
              tests::FailsWith(ErrorCode::unsupported, "expected 2969.6 to 266903.9 Hz"));
  EXPECT_FALSE(blanking_for(100, 300'000'000, 1024, range));
  EXPECT_FALSE(blanking_for(215e3, 0, 1024, range));
}

} // namespace
} // namespace octascope::hal::linux_backend
