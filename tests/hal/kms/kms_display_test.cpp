// The console display where there is no console: it says what is missing. What it shows where there
// is one, tests/virtual_hardware/kms proves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/kms/drm/card_survey.h"
#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::KmsConfig;
using hal::linux_backend::KmsDisplay;

KmsConfig config_of(std::string mode) {
  KmsConfig config;
  config.mode = std::move(mode);
  config.connector = "no such socket";
  config.seat = KmsConfig::SeatUse::plain;
  return config;
}

TEST(KmsDisplay, without_an_output_stays_absent_and_says_why) {
  hal::linux_backend::MonotonicClock clock;
  KmsDisplay display{clock, config_of("")};
  EXPECT_EQ(display.backend(), "kms");
  EXPECT_FALSE(display.simulated());
  for (int i = 0; i < 3; ++i) {
    const auto opened = display.open({});
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().message, testing::HasSubstr("; ")) << "what to do";
    EXPECT_EQ(display.state(), hal::DeviceState::absent);
  }
  EXPECT_THAT(display.present(), FailsWith(hal::ErrorCode::absent));
  EXPECT_EQ(display.width(), 0);
  EXPECT_EQ(display.poll_events({}), 0U);
  EXPECT_EQ(display.description(), "");
  display.close();
}

TEST(KmsDisplay, refuses_nonsense_before_it_touches_anything) {
  hal::linux_backend::MonotonicClock clock;
  KmsDisplay display{clock, config_of("big")};
  EXPECT_THAT(display.open({}), FailsWith(hal::ErrorCode::invalid_argument));
  hal::DisplayConfig nothing;
  nothing.width = 0;
  EXPECT_EQ(display.open(nothing).error().code, hal::ErrorCode::invalid_argument);
}

TEST(KmsSurvey, has_every_card_once) {
  const auto cards = hal::linux_backend::kms::survey();
  EXPECT_EQ(cards.size(), hal::linux_backend::kms::card_nodes().size());
}

} // namespace
} // namespace octascope::tests
