#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <drm_mode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/kms/mode/mode_choice.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/mutation.h"

namespace octascope::tests {
namespace {

using namespace hal::linux_backend::kms;
using testing::HasSubstr;

Mode mode_of(int width, int height, double hz, std::uint32_t type = 0, std::uint32_t flags = 0) {
  Mode mode = computed_mode(width, height, 60);
  mode.clock_khz = static_cast<std::uint32_t>(std::lround(hz * mode.htotal * mode.vtotal / 1000));
  mode.type = type;
  mode.flags = flags;
  return mode;
}

// VESA's own figures for these modes (the spreadsheet of CVT 1.1).
TEST(ComputedMode, is_what_cvt_says) {
  struct Known {
    int width, height;
    double hz;
    unsigned clock_khz;
    int hsync_start, hsync_end, htotal, vsync_start, vsync_end, vtotal;
  };
  for (const Known& known : {Known{640, 480, 60, 23750, 664, 720, 800, 483, 487, 500},
                             Known{1024, 768, 60, 63500, 1072, 1176, 1328, 771, 775, 798},
                             Known{1280, 720, 60, 74500, 1344, 1472, 1664, 723, 728, 748},
                             Known{1920, 1080, 60, 173000, 2048, 2248, 2576, 1083, 1088, 1120},
                             Known{1920, 1200, 60, 193250, 2056, 2256, 2592, 1203, 1209, 1245}}) {
    const Mode mode = computed_mode(known.width, known.height, known.hz);
    SCOPED_TRACE(to_text(mode));
    EXPECT_EQ(mode.clock_khz, known.clock_khz);
    EXPECT_EQ(mode.width, known.width);
    EXPECT_EQ(mode.hsync_start, known.hsync_start);
    EXPECT_EQ(mode.hsync_end, known.hsync_end);
    EXPECT_EQ(mode.htotal, known.htotal);
    EXPECT_EQ(mode.height, known.height);
    EXPECT_EQ(mode.vsync_start, known.vsync_start);
    EXPECT_EQ(mode.vsync_end, known.vsync_end);
    EXPECT_EQ(mode.vtotal, known.vtotal);
    EXPECT_EQ(mode.flags, unsigned{DRM_MODE_FLAG_NHSYNC | DRM_MODE_FLAG_PVSYNC});
  }
}

TEST(ComputedMode, has_its_parts_in_order_and_nearly_the_rate_for_any_size) {
  std::mt19937_64 random{8};
  for (int i = 0; i < 20000; ++i) {
    const int width = std::uniform_int_distribution{100, 8192}(random);
    const int height = std::uniform_int_distribution{100, 4320}(random);
    const double hz = std::uniform_real_distribution{20.0, 150.0}(random);
    const Mode mode = computed_mode(width, height, hz);
    ASSERT_EQ(mode.width, width - width % 8);
    ASSERT_LE(mode.width, mode.hsync_start);
    ASSERT_LE(mode.hsync_start, mode.hsync_end);
    ASSERT_LE(mode.hsync_end, mode.htotal);
    ASSERT_LT(mode.height, mode.vsync_start);
    ASSERT_LT(mode.vsync_start, mode.vsync_end);
    ASSERT_LT(mode.vsync_end, mode.vtotal);
    // The clock goes in steps of 250 kHz, sync and back porch in whole lines, at least 13 of them.
    const double clock_step = 250.0 / mode.clock_khz;
    ASSERT_NEAR(refresh_hz(mode), hz, (0.01 + clock_step + 13.0 / height) * hz)
        << width << 'x' << height;
  }
}

TEST(ModeRequest, is_read_as_written) {
  EXPECT_EQ(parse_mode_request("")->width, 0);
  EXPECT_EQ(parse_mode_request("preferred")->width, 0);
  const auto plain = parse_mode_request("1920x1080");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->width, 1920);
  EXPECT_EQ(plain->height, 1080);
  EXPECT_FALSE(plain->refresh_hz);
  EXPECT_FALSE(plain->computed);
  const auto full = parse_mode_request("800x600M@59.94");
  ASSERT_TRUE(full);
  EXPECT_EQ(full->width, 800);
  EXPECT_TRUE(full->computed);
  EXPECT_DOUBLE_EQ(full->refresh_hz.value_or(0), 59.94);
}

TEST(ModeRequest, that_makes_no_sense_is_refused_with_examples) {
  for (const char* const text :
       {"1920", "x1080", "1920x", "1920x1080@", "1920x1080@0", "1920x1080@nan", "1920x1080@60Hz",
        "1920 x 1080", "-5x100", "99x99", "99999x10", "1920x1080m", "1920x1080@inf", "prefered"}) {
    EXPECT_THAT(parse_mode_request(text),
                FailsWith(hal::ErrorCode::invalid_argument, text, "\"1920x1080@60\""));
  }
}

TEST(ModeRequest, of_any_bytes_is_refused_or_sane) {
  std::mt19937_64 random{11};
  for (int i = 0; i < 20000; ++i) {
    const auto wanted = parse_mode_request(mutate("1920x1080M@59.94", random));
    if (!wanted || wanted->width == 0)
      continue;
    ASSERT_GE(wanted->width, 100);
    ASSERT_LE(wanted->height, 16384);
    ASSERT_GE(wanted->refresh_hz.value_or(60), 1);
    ASSERT_LE(wanted->refresh_hz.value_or(60), 1000);
  }
}

TEST(ModeChoice, takes_the_preferred_one_unless_asked) {
  const std::vector<Mode> modes{mode_of(3840, 2160, 30), mode_of(1920, 1080, 60),
                                mode_of(1920, 1080, 50, DRM_MODE_TYPE_PREFERRED),
                                mode_of(1280, 720, 60, DRM_MODE_TYPE_PREFERRED)};
  const auto chosen = choose_mode(modes, {});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(to_text(*chosen), to_text(modes[2]));
}

TEST(ModeChoice, takes_the_first_where_none_is_preferred) {
  const std::vector<Mode> modes{mode_of(1280, 1024, 75), mode_of(1920, 1080, 60)};
  EXPECT_EQ(choose_mode(modes, {})->width, 1280);
}

TEST(ModeChoice, takes_the_nearest_rate_but_not_another_one) {
  const std::vector<Mode> modes{mode_of(1920, 1080, 60), mode_of(1920, 1080, 59.94),
                                mode_of(1920, 1080, 50), mode_of(1280, 720, 75)};
  EXPECT_NEAR(refresh_hz(*choose_mode(modes, {1920, 1080, 60.0})), 60, 0.01);
  EXPECT_NEAR(refresh_hz(*choose_mode(modes, {1920, 1080, 59.9})), 59.94, 0.01);
  EXPECT_NEAR(refresh_hz(*choose_mode(modes, {1920, 1080, 50.2})), 50, 0.01);
  EXPECT_THAT(choose_mode(modes, {1920, 1080, 75.0}),
              FailsWith(hal::ErrorCode::unsupported, "1280x720@75.00", "1920x1080M"));
}

TEST(ModeChoice, passes_over_interlaced_ones) {
  const std::vector<Mode> modes{
      mode_of(1920, 1080, 50, DRM_MODE_TYPE_PREFERRED, DRM_MODE_FLAG_INTERLACE),
      mode_of(1920, 1080, 25)};
  EXPECT_EQ(choose_mode(modes, {1920, 1080, {}})->flags, 0U);
}

TEST(ModeChoice, computes_what_is_in_no_list) {
  const auto chosen = choose_mode({}, {320, 200, {}, true});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->width, 320);
  EXPECT_NEAR(refresh_hz(*chosen), 60, 1.5);
  EXPECT_FALSE(choose_mode({}, {320, 200, {}, false}));
}

TEST(ModeChoice, survives_timings_of_zero) {
  const std::vector<Mode> modes{Mode{}, Mode{}};
  EXPECT_FALSE(choose_mode(modes, {}));
  EXPECT_EQ(refresh_hz(modes[0]), 0);
}

} // namespace
} // namespace octascope::tests
