// The display under a manager of seats: the console is switched away and back, as often and
// whenever anybody likes.
#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include <GLES3/gl3.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/system/file_descriptor.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/kms/fake_seat.h"
#include "tests/virtual_hardware/kms/vkms_card.h"
#include "tests/virtual_hardware/support/scanout_reader.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::FileDescriptor;
using hal::linux_backend::KmsConfig;
using hal::linux_backend::KmsDisplay;
using testing::AllOf;
using testing::HasSubstr;

// Tells whether it is listened to, and one key for each time that it is asked.
class KeysOfTest final : public hal::KeySource {
public:
  explicit KeysOfTest(bool& listened_to) : listened_to_{listened_to} {}

private:
  void do_attend(bool ours) override { listened_to_ = ours; }
  std::size_t do_poll_events(std::span<hal::DisplayEvent> events) override {
    events.front().key = 'o';
    return 1;
  }

  bool& listened_to_;
};

class KmsSeat : public testing::TestWithParam<bool> {
protected:
  void SetUp() override {
    auto card = find_vkms();
    if (!card)
      GTEST_SKIP() << no_vkms;
    card_ = *std::move(card);
    setenv("LIBSEAT_BACKEND", "fake", 1);
    fake_seat() = {};
    config_.mode = "320x200M@60";
    config_.atomic = GetParam();
    config_.seat = KmsConfig::SeatUse::managed;
  }
  void TearDown() override {
    display_.reset();
    EXPECT_EQ(fake_seat().seats, 0);
    EXPECT_EQ(fake_seat().opened, 0);
    unsetenv("LIBSEAT_BACKEND");
  }

  void open() {
    display_.emplace(clock_, config_);
    const auto opened = display_->open({});
    ASSERT_TRUE(opened) << opened.error().message;
  }

  // What present() gives, after a picture of that colour.
  hal::Flip show(float red) {
    glClearColor(red, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const auto flip = display_->present();
    EXPECT_TRUE(flip) << flip.error().message;
    return flip.value_or(hal::Flip{});
  }

  // Whoever opens the card while we are away is its master.
  void switch_output_off() const {
    const FileDescriptor other{::open(card_.node.c_str(), O_RDWR | O_CLOEXEC)};
    drmModeRes* const resources = drmModeGetResources(other.get());
    ASSERT_NE(resources, nullptr);
    EXPECT_EQ(drmModeSetCrtc(other.get(), resources->crtcs[0], 0, 0, 0, nullptr, 0, nullptr), 0);
    drmModeFreeResources(resources);
  }

  hal::linux_backend::MonotonicClock clock_;
  hal::linux_backend::kms::Card card_;
  KmsConfig config_;
  std::optional<KmsDisplay> display_;
};

INSTANTIATE_TEST_SUITE_P(Calls, KmsSeat, testing::Bool(), [](const auto& with) {
  return std::string{with.param ? "atomic" : "legacy"};
});

TEST_P(KmsSeat, keys_are_ours_while_the_display_is_open_and_its_console_in_front) {
  bool listened_to = false;
  display_.emplace(clock_, config_, std::make_unique<KeysOfTest>(listened_to));
  EXPECT_FALSE(listened_to);
  ASSERT_TRUE(display_->open({}));
  EXPECT_TRUE(listened_to);
  std::array<hal::DisplayEvent, 1> events;
  EXPECT_EQ(display_->poll_events(events), 1U);
  EXPECT_EQ(events[0].key, 'o');
  fake_seat().switch_away();
  show(1);
  EXPECT_FALSE(listened_to);
  fake_seat().switch_back();
  show(1);
  show(1);
  EXPECT_TRUE(listened_to);
  display_->close();
  EXPECT_FALSE(listened_to);
}

TEST_P(KmsSeat, the_card_comes_from_the_manager_and_goes_back) {
  open();
  EXPECT_EQ(fake_seat().opened, 1);
  EXPECT_EQ(show(1).sequence, 1U);
  EXPECT_EQ(red_on_screen(), 255);
  display_->close();
  EXPECT_EQ(fake_seat().opened, 0);
  EXPECT_EQ(fake_seat().seats, 0);
}

TEST_P(KmsSeat, away_it_shows_nothing_and_back_it_sets_the_mode) {
  open();
  EXPECT_EQ(show(1).sequence, 1U);
  for (unsigned round = 1; round <= 3; ++round) {
    fake_seat().switch_away();
    const hal::TimePoint begin = clock_.now();
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(show(0.2F).sequence, round) << "nothing was shown";
    EXPECT_TRUE(fake_seat().acknowledged) << "the manager waits for it";
    EXPECT_GE(hal::to_seconds(clock_.now() - begin), 0.15) << "no busy loop";

    switch_output_off(); // as the other console's program leaves it
    fake_seat().switch_back();
    EXPECT_EQ(show(0.2F * static_cast<float>(round)).sequence, round + 1);
    EXPECT_EQ(red_on_screen(), 51 * static_cast<int>(round));
  }
  EXPECT_EQ(display_->state(), hal::DeviceState::ready);
}

TEST_P(KmsSeat, away_and_back_between_two_pictures_is_survived) {
  open();
  EXPECT_EQ(show(1).sequence, 1U);
  fake_seat().switch_away();
  switch_output_off();
  fake_seat().switch_back();
  unsigned tries = 0;
  while (show(0.4F).sequence < 2 && tries < 5)
    ++tries;
  EXPECT_EQ(red_on_screen(), 102);
}

TEST_P(KmsSeat, a_cable_pulled_while_away_is_noticed) {
  open();
  fake_seat().switch_away();
  EXPECT_EQ(show(1).sequence, 0U);
  ASSERT_TRUE(set_cable(card_, "off"));
  const auto flip = display_->present();
  ASSERT_TRUE(set_cable(card_, "detect"));
  ASSERT_THAT(flip, FailsWith(hal::ErrorCode::disconnected));
}

TEST_P(KmsSeat, it_may_be_closed_while_away) {
  open();
  fake_seat().switch_away();
  EXPECT_EQ(show(1).sequence, 0U);
  display_->close();
  EXPECT_EQ(display_->state(), hal::DeviceState::absent);
  EXPECT_THAT(display_->open({}), FailsWith(hal::ErrorCode::busy, "another console", "seat0"));
  fake_seat().in_front = true;
  EXPECT_TRUE(display_->open({}));
}

TEST_P(KmsSeat, where_nobody_manages_seats_it_says_so_or_helps_itself) {
  fake_seat().answers = false;
  display_.emplace(clock_, config_);
  EXPECT_THAT(display_->open({}), FailsWith(hal::ErrorCode::absent, "seatd", "--no-seat"));
  config_.seat = KmsConfig::SeatUse::automatic;
  open();
  EXPECT_EQ(show(1).sequence, 1U);
}

} // namespace
} // namespace octascope::tests
