// A graphics processor that is reset while the kernel's virtual display shows its pictures.
#include <optional>

#include <GLES3/gl3.h>
// Needs what the line above declares.
#include <GLES2/gl2ext.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/kms/fake_driver.h"
#include "tests/virtual_hardware/kms/vkms_card.h"
#include "tests/virtual_hardware/support/scanout_reader.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::KmsConfig;
using hal::linux_backend::KmsDisplay;
using testing::AllOf;
using testing::HasSubstr;

class KmsReset : public testing::Test {
protected:
  void SetUp() override {
    if (!find_vkms())
      GTEST_SKIP() << no_vkms;
    fake_driver() = {};
    fake_driver().tells_of_resets = true;
  }
  void TearDown() override { fake_driver() = {}; }

  static KmsConfig config() {
    KmsConfig config;
    config.mode = "320x200M@60";
    return config;
  }

  hal::Result<hal::Flip> show(float red) {
    glClearColor(red, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    return display_.present();
  }

  hal::linux_backend::MonotonicClock clock_;
  KmsDisplay display_{clock_, config()};
};

class EveryKmsReset : public KmsReset, public testing::WithParamInterface<unsigned> {};

INSTANTIATE_TEST_SUITE_P(Statuses, EveryKmsReset,
                         testing::Values(GL_GUILTY_CONTEXT_RESET_KHR, GL_INNOCENT_CONTEXT_RESET_KHR,
                                         GL_UNKNOWN_CONTEXT_RESET_KHR),
                         [](const auto& with) -> std::string {
                           switch (with.param) {
                           case GL_GUILTY_CONTEXT_RESET_KHR: return "guilty";
                           case GL_INNOCENT_CONTEXT_RESET_KHR: return "innocent";
                           default: return "unknown";
                           }
                         });

TEST_P(EveryKmsReset, is_found_before_the_next_flip_and_over_when_the_display_is_opened_again) {
  ASSERT_TRUE(display_.open({}));
  ASSERT_TRUE(show(0.2F));
  fake_driver().status = GetParam();
  EXPECT_THAT(show(1), FailsWith(hal::ErrorCode::disconnected, "was reset", "opened again"));
  EXPECT_EQ(display_.state(), hal::DeviceState::failed);

  display_.close();
  fake_driver().status = GL_NO_ERROR;
  const auto opened = display_.open({});
  ASSERT_TRUE(opened) << opened.error().message;
  const auto again = show(0.6F);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(red_on_screen(), 153);
}

// The processor may take a while: until it is there again, every context is lost, and the render
// thread tries again.
TEST_P(EveryKmsReset, that_takes_long_lets_no_display_open) {
  fake_driver().status = GetParam();
  for (int i = 0; i < 3; ++i) {
    EXPECT_THAT(display_.open({}), FailsSaying("was reset"));
    EXPECT_EQ(display_.state(), hal::DeviceState::absent);
  }
  fake_driver().status = GL_NO_ERROR;
  ASSERT_TRUE(display_.open({}));
  ASSERT_TRUE(show(0.4F));
  EXPECT_EQ(red_on_screen(), 102);
}

TEST_F(KmsReset, is_asked_for_once_a_picture) {
  ASSERT_TRUE(display_.open({}));
  const int before = fake_driver().asked;
  for (int i = 0; i < 5; ++i)
    ASSERT_TRUE(show(0.5F));
  EXPECT_EQ(fake_driver().asked - before, 5);
}

TEST_F(KmsReset, that_no_specification_knows_is_none) {
  ASSERT_TRUE(display_.open({}));
  fake_driver().status = 0xdead;
  EXPECT_TRUE(show(0.5F));
}

TEST_F(KmsReset, of_a_driver_that_makes_no_such_context_is_never_known) {
  fake_driver().refuses = true;
  fake_driver().status = GL_GUILTY_CONTEXT_RESET_KHR;
  const auto opened = display_.open({});
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(show(0.5F));
  EXPECT_EQ(fake_driver().asked, 0);
}

// As the bench's own driver, and Mesa's wherever no GPU is.
TEST_F(KmsReset, of_a_driver_that_cannot_tell_is_never_known) {
  fake_driver().tells_of_resets = false;
  fake_driver().status = GL_GUILTY_CONTEXT_RESET_KHR;
  ASSERT_TRUE(display_.open({}));
  EXPECT_TRUE(show(0.5F));
  EXPECT_EQ(fake_driver().asked, 0);
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << "the question is left behind as an error";
}

} // namespace
} // namespace octascope::tests
