// Everything that can happen to a display while it is used, on the kernel's virtual one: said in
// words, survived, and over when it is over; nothing is left behind.
#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include <GLES3/gl3.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "hal/linux/kms/kms_display.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/system/file_descriptor.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/kms/vkms_card.h"
#include "tests/virtual_hardware/support/resource_count.h"
#include "tests/virtual_hardware/support/scanout_reader.h"
#include "tests/virtual_hardware/support/without_permission.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::FileDescriptor;
using hal::linux_backend::KmsConfig;
using hal::linux_backend::KmsDisplay;
using hal::linux_backend::kms::Card;
using testing::AllOf;
using testing::HasSubstr;

// Of the whole kernel: where vkms keeps its buffers.
long shared_kib() {
  long shared = 0;
  std::ifstream memory{"/proc/meminfo"};
  for (std::string word; memory >> word;)
    if (word == "Shmem:")
      memory >> shared;
  return shared;
}

// The descriptor by which this process's display holds the card.
int descriptor_of(const Card& card) {
  for (const auto& entry : std::filesystem::directory_iterator{"/proc/self/fd"}) {
    std::error_code gone;
    if (std::filesystem::read_symlink(entry.path(), gone) == card.node)
      return std::stoi(entry.path().filename().string());
  }
  return -1;
}

double cpu_seconds() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

class KmsFault : public testing::TestWithParam<bool> {
protected:
  void SetUp() override {
    auto card = find_vkms();
    if (!card)
      GTEST_SKIP() << no_vkms;
    card_ = *std::move(card);
    config_.mode = "320x200M@60";
    config_.atomic = GetParam();
  }
  void TearDown() override {
    if (!card_.node.empty())
      set_cable(card_, "detect");
  }

  KmsDisplay make() { return KmsDisplay{clock_, config_}; }

  static void show(KmsDisplay& display, float red) {
    glClearColor(red, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const auto flip = display.present();
    ASSERT_TRUE(flip) << flip.error().message;
  }

  hal::Error failure_of(const KmsConfig& config) {
    KmsDisplay display{clock_, config};
    const auto opened = display.open({});
    EXPECT_FALSE(opened);
    EXPECT_EQ(display.state(), hal::DeviceState::absent);
    return opened ? hal::Error{} : opened.error();
  }

  // What differs between the calls is little. Slack is for what libraries keep once: a leak of one
  // a cycle is ten times that.
  static void expect_nothing_left_by(const std::function<void()>& cycle) {
    for (int i = 0; i < 10; ++i)
      cycle();
    const long shared_before = shared_kib();
    const ResourceCount before = resources_in_use();
    for (int i = 0; i < (GetParam() ? leak_cycles() : std::min(leak_cycles(), 50)) && !HasFailure();
         ++i)
      cycle();
    constexpr Slack slack{.mappings = 20, .heap_bytes = std::size_t{2000} * 1024};
    const ResourceCount after = expect_no_leak(before, slack);
    EXPECT_GE(after.mappings + slack.mappings, before.mappings);
    EXPECT_GE(after.heap_bytes + slack.heap_bytes, before.heap_bytes);
    EXPECT_NEAR(static_cast<double>(shared_kib()), static_cast<double>(shared_before), 4000);
  }

  hal::linux_backend::MonotonicClock clock_;
  Card card_;
  KmsConfig config_;
};

INSTANTIATE_TEST_SUITE_P(Calls, KmsFault, testing::Bool(), [](const auto& with) {
  return std::string{with.param ? "atomic" : "legacy"};
});

TEST_P(KmsFault, a_pulled_cable_is_said_and_over_when_it_is_back) {
  KmsDisplay display = make();
  ASSERT_TRUE(display.open({}));
  ASSERT_NO_FATAL_FAILURE(show(display, 1));
  ASSERT_TRUE(set_cable(card_, "off"));
  EXPECT_THAT(display.present(), FailsWith(hal::ErrorCode::disconnected, "Virtual-1", "cable"));
  EXPECT_EQ(display.state(), hal::DeviceState::failed);
  EXPECT_FALSE(display.present()) << "only close() and open() lead on";
  display.close();
  EXPECT_EQ(display.state(), hal::DeviceState::absent);

  EXPECT_THAT(display.open({}),
              FailsWith(hal::ErrorCode::absent, "Virtual-1 (disconnected)", "cable"));

  ASSERT_TRUE(set_cable(card_, "detect"));
  const auto again = display.open({});
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_NO_FATAL_FAILURE(show(display, 0.4F));
  EXPECT_EQ(red_on_screen(), 102);
}

// The card is taken from us (as a switch to another console does) and given back.
TEST_P(KmsFault, a_lost_card_pauses_and_its_return_sets_the_mode_again) {
  KmsDisplay display = make();
  ASSERT_TRUE(display.open({}));
  ASSERT_NO_FATAL_FAILURE(show(display, 1));
  const int ours = descriptor_of(card_);
  ASSERT_GE(ours, 0);
  ASSERT_EQ(drmDropMaster(ours), 0);
  FileDescriptor other{::open(card_.node.c_str(), O_RDWR | O_CLOEXEC)};
  ASSERT_NE(drmIsMaster(other.get()), 0);

  const double cpu_before = cpu_seconds();
  const hal::TimePoint begin = clock_.now();
  for (int i = 0; i < 8; ++i) {
    const auto flip = display.present();
    ASSERT_TRUE(flip) << flip.error().message;
    EXPECT_EQ(flip->sequence, 1U) << "nothing was shown";
  }
  const double elapsed = hal::to_seconds(clock_.now() - begin);
  EXPECT_GE(elapsed, 0.5);
  EXPECT_LT(cpu_seconds() - cpu_before, 0.5 * elapsed);
  EXPECT_EQ(display.state(), hal::DeviceState::ready);

  // What the other one leaves: the output off.
  drmModeRes* const resources = drmModeGetResources(other.get());
  ASSERT_EQ(drmModeSetCrtc(other.get(), resources->crtcs[0], 0, 0, 0, nullptr, 0, nullptr), 0);
  drmModeFreeResources(resources);
  EXPECT_EQ(red_on_screen(), -1);
  other.reset();

  ASSERT_NO_FATAL_FAILURE(show(display, 0.2F));
  EXPECT_EQ(red_on_screen(), 51);
  ASSERT_NO_FATAL_FAILURE(show(display, 0.6F));
  EXPECT_EQ(red_on_screen(), 153);
}

TEST_P(KmsFault, another_program_on_the_card_is_named_as_the_reason) {
  FileDescriptor other{::open(card_.node.c_str(), O_RDWR | O_CLOEXEC)};
  ASSERT_NE(drmIsMaster(other.get()), 0);
  const hal::Error error = failure_of(config_);
  EXPECT_EQ(error.code, hal::ErrorCode::busy);
  EXPECT_THAT(error.message, AllOf(HasSubstr("another program"), HasSubstr("fuser")));
  other.reset();
  KmsDisplay display = make();
  EXPECT_TRUE(display.open({}));
}

TEST_P(KmsFault, a_card_that_must_not_be_opened_is_said_with_the_mend) {
  check_as_nobody([&] {
    const hal::Error error = failure_of(config_);
    EXPECT_EQ(error.code, hal::ErrorCode::denied);
    EXPECT_THAT(error.message, AllOf(HasSubstr(card_.node), HasSubstr("usermod")));
  });
}

TEST_P(KmsFault, requests_that_cannot_be_met_are_answered_with_what_there_is) {
  KmsConfig config = config_;
  config.mode = "1234x777";
  hal::Error error = failure_of(config);
  EXPECT_EQ(error.code, hal::ErrorCode::unsupported);
  EXPECT_THAT(error.message, AllOf(HasSubstr("1234x777"), HasSubstr("1024x768@60.00")));
  config.mode = "large";
  error = failure_of(config);
  EXPECT_EQ(error.code, hal::ErrorCode::invalid_argument);
  config = config_;
  config.connector = "DP-7";
  error = failure_of(config);
  EXPECT_EQ(error.code, hal::ErrorCode::absent);
  EXPECT_THAT(error.message, AllOf(HasSubstr("DP-7"), HasSubstr("Virtual-1")));
  config = config_;
  config.overscan.left = 60;
  error = failure_of(config);
  EXPECT_EQ(error.code, hal::ErrorCode::invalid_argument);
}

// The kernel says "something changed" where nothing did: the picture stays.
TEST_P(KmsFault, needless_events_change_nothing) {
  KmsDisplay display = make();
  ASSERT_TRUE(display.open({}));
  for (int i = 0; i < 5; ++i) {
    std::ofstream{"/sys/class/drm/" + card_name(card_) + "/uevent"} << "change" << std::flush;
    ASSERT_NO_FATAL_FAILURE(show(display, 0.2F));
  }
  EXPECT_EQ(red_on_screen(), 51);
}

TEST_P(KmsFault, showing_pictures_allocates_nothing) {
  KmsDisplay display = make();
  ASSERT_TRUE(display.open({}));
  for (int i = 0; i < 4; ++i) // until every buffer is known
    ASSERT_NO_FATAL_FAILURE(show(display, 0.2F));
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 0; i < 10; ++i)
    static_cast<void>(display.present());
  EXPECT_EQ(allocations_of_this_thread() - before, 0U);
}

TEST_P(KmsFault, many_openings_leave_nothing_behind) {
  KmsDisplay display = make();
  expect_nothing_left_by([&] {
    const auto opened = display.open({});
    ASSERT_TRUE(opened) << opened.error().message;
    ASSERT_NO_FATAL_FAILURE(show(display, 0.5F));
    display.close();
  });
}

TEST_P(KmsFault, many_pulled_cables_leave_nothing_behind) {
  KmsDisplay display = make();
  expect_nothing_left_by([&] {
    ASSERT_TRUE(display.open({}));
    ASSERT_TRUE(set_cable(card_, "off"));
    EXPECT_THAT(display.present(), FailsWith(hal::ErrorCode::disconnected));
    display.close();
    EXPECT_FALSE(display.open({}));
    ASSERT_TRUE(set_cable(card_, "detect"));
  });
}

} // namespace
} // namespace octascope::tests
