// What every display must do. An implementation's test defines a maker and instantiates the suite:
//
//   struct OffscreenMaker { ...; std::optional<std::string> unavailable(); hal::Display& display();
//   }; INSTANTIATE_TYPED_TEST_SUITE_P(Offscreen, DisplayContract, OffscreenMaker);
//
// unavailable() says why the implementation cannot run on this machine; the tests then skip.
#pragma once

#include <array>
#include <cstdint>

#include <GLES3/gl3.h>
#include <gtest/gtest.h>

#include "hal/display.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {

template <class Maker> class DisplayContract : public testing::Test {
protected:
  void SetUp() override {
    if (const auto reason = maker_.unavailable())
      GTEST_SKIP() << *reason;
  }

  static hal::DisplayConfig config() {
    hal::DisplayConfig result;
    result.width = 320;
    result.height = 200;
    return result;
  }

  hal::Display& display() { return maker_.display(); }

  Maker maker_;
};

TYPED_TEST_SUITE_P(DisplayContract);

TYPED_TEST_P(DisplayContract, opens_from_absent_to_ready_with_a_gles_3_context) {
  hal::Display& display = this->display();
  EXPECT_EQ(display.state(), hal::DeviceState::absent);
  const auto opened = display.open(this->config());
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(display.state(), hal::DeviceState::ready);
  EXPECT_EQ(display.width(), 320);
  EXPECT_EQ(display.height(), 200);
  EXPECT_GT(display.refresh_period().count(), 0);
  EXPECT_FALSE(display.backend().empty());
  GLint major = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  EXPECT_GE(major, 3);
  display.close();
  EXPECT_EQ(display.state(), hal::DeviceState::absent);
}

TYPED_TEST_P(DisplayContract, draws_into_the_bound_framebuffer) {
  hal::Display& display = this->display();
  ASSERT_TRUE(display.open(this->config()));
  glClearColor(0.2F, 0.4F, 0.6F, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  std::array<std::uint8_t, 4> pixel{};
  glReadPixels(160, 100, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  EXPECT_EQ(pixel, (std::array<std::uint8_t, 4>{51, 102, 153, 255}));
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  const auto flip = display.present();
  EXPECT_TRUE(flip) << flip.error().message;
}

TYPED_TEST_P(DisplayContract, flips_count_up_in_time_and_no_faster_than_the_refresh) {
  hal::Display& display = this->display();
  ASSERT_TRUE(display.open(this->config()));
  constexpr int frames = 10;
  hal::TimePoint first;
  hal::Flip last;
  for (int i = 1; i <= frames; ++i) {
    glClear(GL_COLOR_BUFFER_BIT);
    const auto flip = display.present();
    ASSERT_TRUE(flip) << flip.error().message;
    EXPECT_EQ(flip->sequence, static_cast<std::uint64_t>(i));
    if (i == 1)
      first = flip->completed;
    else
      EXPECT_GE(flip->completed, last.completed);
    last = *flip;
  }
  // Eight of the nine periods between: the first one may have begun anywhere.
  EXPECT_GE(last.completed - first, (frames - 2) * display.refresh_period());
}

TYPED_TEST_P(DisplayContract, polling_events_does_not_wait_and_writes_no_more_than_asked) {
  hal::Display& display = this->display();
  ASSERT_TRUE(display.open(this->config()));
  std::array<hal::DisplayEvent, 4> events;
  EXPECT_LE(display.poll_events(events), events.size());
  EXPECT_EQ(display.poll_events({}), 0U);
}

TYPED_TEST_P(DisplayContract, refuses_what_makes_no_sense_and_stays_absent) {
  hal::Display& display = this->display();
  hal::DisplayConfig no_width = this->config();
  no_width.width = 0;
  hal::DisplayConfig no_rate = this->config();
  no_rate.refresh_hz = 0;
  for (const hal::DisplayConfig& config : {no_width, no_rate}) {
    EXPECT_THAT(display.open(config), FailsWith(hal::ErrorCode::invalid_argument, "expected"));
    EXPECT_EQ(display.state(), hal::DeviceState::absent);
  }
}

TYPED_TEST_P(DisplayContract, says_so_when_it_is_not_open_or_opened_twice) {
  hal::Display& display = this->display();
  const auto flip = display.present();
  ASSERT_THAT(flip, FailsWith(hal::ErrorCode::absent));
  ASSERT_TRUE(display.open(this->config()));
  EXPECT_THAT(display.open(this->config()), FailsWith(hal::ErrorCode::busy));
  EXPECT_EQ(display.state(), hal::DeviceState::ready);
}

TYPED_TEST_P(DisplayContract, opens_again_after_close) {
  hal::Display& display = this->display();
  for (int i = 0; i < 3; ++i) {
    const auto opened = display.open(this->config());
    ASSERT_TRUE(opened) << opened.error().message;
    glClear(GL_COLOR_BUFFER_BIT);
    const auto flip = display.present();
    ASSERT_TRUE(flip) << flip.error().message;
    EXPECT_EQ(flip->sequence, 1U);
    display.close();
    display.close();
  }
}

REGISTER_TYPED_TEST_SUITE_P(DisplayContract, opens_from_absent_to_ready_with_a_gles_3_context,
                            draws_into_the_bound_framebuffer,
                            flips_count_up_in_time_and_no_faster_than_the_refresh,
                            polling_events_does_not_wait_and_writes_no_more_than_asked,
                            refuses_what_makes_no_sense_and_stays_absent,
                            says_so_when_it_is_not_open_or_opened_twice, opens_again_after_close);

} // namespace octascope::tests
