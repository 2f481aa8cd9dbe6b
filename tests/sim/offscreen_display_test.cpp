#include <optional>
#include <string>
#include <thread>

#include "sim/clock/virtual_clock.h"
#include "sim/devices/offscreen_display.h"
#include "tests/contract/display_contract.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {
namespace {

struct OffscreenMaker {
  sim::VirtualClock clock;
  sim::OffscreenDisplay offscreen{clock};

  hal::Display& display() { return offscreen; }
  std::optional<std::string> unavailable() {
    const auto opened = offscreen.open({});
    offscreen.close();
    return opened ? std::nullopt : std::optional{opened.error().message};
  }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Offscreen, DisplayContract, OffscreenMaker);

class OffscreenDisplay : public testing::Test {
protected:
  void SetUp() override {
    if (const auto opened = display_.open({}); !opened)
      GTEST_SKIP() << opened.error().message;
  }

  sim::VirtualClock clock_;
  sim::OffscreenDisplay display_{clock_};
};

TEST_F(OffscreenDisplay, is_a_twin) {
  EXPECT_TRUE(display_.simulated());
  EXPECT_EQ(display_.backend(), "offscreen");
}

TEST_F(OffscreenDisplay, frames_fall_on_the_ticks_of_the_clock) {
  const hal::TimePoint opened = clock_.now();
  const hal::Duration period = display_.refresh_period();
  EXPECT_NEAR(hal::to_ms(period), 1000.0 / 60, 1e-5);
  ASSERT_TRUE(display_.present());
  EXPECT_EQ(clock_.now(), opened + period);
  clock_.advance(period * 5 / 2); // a slow drawing misses two ticks
  const auto flip = display_.present();
  ASSERT_TRUE(flip);
  EXPECT_EQ(flip->completed, opened + period * 7 / 2);
  EXPECT_EQ(clock_.now(), opened + 4 * period);
}

TEST_F(OffscreenDisplay, a_lost_display_fails_and_comes_back) {
  ASSERT_TRUE(display_.present());
  std::thread{[&] { display_.lose(); }}.join();
  for (int i = 0; i < 2; ++i) {
    EXPECT_THAT(display_.present(), FailsWith(hal::ErrorCode::disconnected));
    EXPECT_EQ(display_.state(), hal::DeviceState::failed);
  }
  display_.close();
  EXPECT_THAT(display_.open({}), FailsWith(hal::ErrorCode::absent));
  EXPECT_EQ(display_.state(), hal::DeviceState::absent);

  display_.restore();
  ASSERT_TRUE(display_.open({}));
  const auto flip = display_.present();
  ASSERT_TRUE(flip);
  EXPECT_EQ(flip->sequence, 1U);
}

TEST_F(OffscreenDisplay, a_loss_between_two_frames_is_noticed) {
  ASSERT_TRUE(display_.present());
  display_.lose();
  display_.restore();
  EXPECT_FALSE(display_.present());
  display_.close();
  ASSERT_TRUE(display_.open({}));
  EXPECT_TRUE(display_.present());
}

TEST_F(OffscreenDisplay, refuses_a_size_beyond_the_gpu) {
  display_.close();
  hal::DisplayConfig config;
  config.width = 1'000'000;
  EXPECT_THAT(display_.open(config), FailsWith(hal::ErrorCode::invalid_argument, "1000000x720"));
}

// Linux ends a program that takes more memory than there is; so it is said before.
TEST(PictureMemory, is_there_or_the_size_is_refused_in_words) {
  constexpr std::uint64_t gib = 1 << 30;
  EXPECT_TRUE(sim::check_picture_memory(16384, 16384, 16 * gib));
  EXPECT_TRUE(sim::check_picture_memory(1, 16384, gib / 64));
  EXPECT_THAT(sim::check_picture_memory(16384, 16384, 2 * gib),
              FailsWith(hal::ErrorCode::invalid_argument, "16384x16384", "11.0 GiB", "2.0 GiB",
                        "choose a smaller size"));
}

} // namespace
} // namespace octascope::tests
