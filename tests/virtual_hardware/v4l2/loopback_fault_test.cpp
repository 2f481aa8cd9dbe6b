// What goes wrong with a camera that v4l2loopback plays, and what it shows of finding one.
#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "hal/linux/v4l2/video_nodes.h"
#include "tests/support/fails_with.h"
#include "tests/virtual_hardware/support/loopback_feeder.h"
#include "tests/virtual_hardware/support/resource_count.h"
#include "tests/virtual_hardware/support/syscall_faults.h"

namespace octascope::tests {
namespace {

using namespace hal;
using namespace hal::linux_backend;
using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr int samples = 320;
constexpr int lines = 48;

LineCameraConfig config_of(int width = samples, int height = lines) {
  return {.format = {.samples_per_line = width,
                     .lines_per_frame = height,
                     .sample_type = SampleType::u16,
                     .significant_bits = 12,
                     .right_shift = 0},
          .line_rate_hz = 10e3,
          .buffers = 96};
}

class LoopbackFault : public testing::Test {
protected:
  void SetUp() override {
    const auto found = LoopbackFeeder::find();
    if (!found)
      GTEST_SKIP() << "no v4l2loopback node: load the module, or run this in the bench's kernel";
    node_ = *found;
  }

  LoopbackFeeder feeder(int width = samples, int height = lines) const {
    auto opened = LoopbackFeeder::open(node_, width, height);
    EXPECT_TRUE(opened) << opened.error().message;
    return std::move(opened.value());
  }

  static std::vector<std::byte> frame_of(const LoopbackFeeder& feeder, int value) {
    return std::vector<std::byte>(feeder.frame_bytes(), static_cast<std::byte>(value));
  }

  std::string node_;
  MonotonicClock clock_;
};

TEST_F(LoopbackFault, without_a_writer_it_is_absent_and_comes_with_one) {
  V4l2LineCamera camera{{.node = node_}, clock_};
  EXPECT_THAT(camera.open(config_of()), FailsWith(ErrorCode::absent, "no format yet"));
  const auto fed = feeder();
  EXPECT_TRUE(camera.open(config_of()));
  for (const std::string& note : camera.notes())
    std::printf("  %s\n", note.c_str());
}

TEST_F(LoopbackFault, another_size_is_refused_with_found_and_expected) {
  const auto fed = feeder(640, 64);
  V4l2LineCamera camera{{.node = node_}, clock_};
  EXPECT_THAT(camera.open(config_of()), FailsWith(ErrorCode::unsupported, "640×64", "320×48"));
  EXPECT_EQ(camera.state(), DeviceState::absent);
  EXPECT_TRUE(camera.open(config_of(640, 64)));
}

TEST_F(LoopbackFault, the_first_that_suits_is_found_again_and_again) {
  const auto fed = feeder();
  const auto candidates = line_camera_candidates(config_of().format);
  const auto first = std::ranges::find_if(candidates, &LineCameraCandidate::suits);
  ASSERT_NE(first, candidates.end());
  V4l2LineCamera camera{{}, clock_};
  for (int i = 0; i < 3; ++i) {
    const auto opened = camera.open(config_of());
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_THAT(camera.notes().front(), HasSubstr(first->identity.node));
    camera.close();
  }
}

TEST_F(LoopbackFault, candidates_are_listed_with_what_they_are_and_why_not) {
  const auto fed = feeder();
  bool suits = false;
  for (const LineCameraCandidate& candidate : line_camera_candidates(config_of().format)) {
    std::printf("  %s \"%s\" %s %s: %s\n", candidate.identity.node.c_str(),
                candidate.identity.card.c_str(), candidate.identity.driver.c_str(),
                candidate.identity.bus.c_str(),
                candidate.suits() ? "suits" : candidate.unsuitable->message.c_str());
    if (candidate.identity.node == node_) {
      suits = candidate.suits();
      EXPECT_EQ(candidate.formats, "Y16 320×48");
    }
    EXPECT_TRUE(candidate.suits() || !candidate.unsuitable->message.empty());
  }
  EXPECT_TRUE(suits);
}

TEST_F(LoopbackFault, bytes_are_those_written_without_a_copy) {
  auto fed = feeder();
  V4l2LineCamera camera{{.node = node_}, clock_};
  ASSERT_TRUE(camera.open(config_of()));
  ASSERT_TRUE(camera.start());
  std::vector<std::byte> written = frame_of(fed, 0);
  for (std::size_t i = 0; i < written.size(); ++i)
    written[i] = static_cast<std::byte>(i * 31 >> 3);
  ASSERT_TRUE(fed.write(written));
  const auto frame = camera.wait_frame(1s);
  ASSERT_TRUE(frame && *frame);
  EXPECT_TRUE(std::ranges::equal((*frame)->bytes, written));
  EXPECT_EQ((*frame)->integrity, FrameIntegrity::good);
  EXPECT_EQ(camera.tally().own_stamps, 0U) << "its stamps lie on our clock";
}

// Each frame is fetched before the next is written, so that the driver has no reason to drop any.
TEST_F(LoopbackFault, frames_of_the_real_size_come_whole_and_in_order) {
  constexpr std::uint64_t frames = 500;
  auto fed = feeder(1024, 379);
  V4l2LineCamera camera{{.node = node_}, clock_};
  ASSERT_TRUE(camera.open(config_of(1024, 379)));
  ASSERT_TRUE(camera.start());
  const TimePoint begin = clock_.now();
  for (std::uint64_t i = 0; i < frames; ++i) {
    const auto whole = frame_of(fed, static_cast<int>(i % 251));
    ASSERT_TRUE(fed.write(whole));
    const auto frame = camera.wait_frame(1s);
    ASSERT_TRUE(frame && *frame);
    ASSERT_EQ((*frame)->sequence, i);
    ASSERT_TRUE(std::ranges::equal((*frame)->bytes, whole)) << i;
    camera.release((*frame)->buffer);
  }
  std::printf("  %.0f frames a second, written, read and compared\n",
              static_cast<double>(frames) / to_seconds(clock_.now() - begin));
}

TEST_F(LoopbackFault, a_short_frame_is_of_the_wrong_size_and_the_next_is_good) {
  auto fed = feeder();
  V4l2LineCamera camera{{.node = node_}, clock_};
  ASSERT_TRUE(camera.open(config_of()));
  ASSERT_TRUE(camera.start());
  const auto whole = frame_of(fed, 7);
  ASSERT_TRUE(fed.write(std::span{whole}.first(1000)));
  auto frame = camera.wait_frame(1s);
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->integrity, FrameIntegrity::wrong_size);
  EXPECT_EQ((*frame)->bytes.size(), 1000U);
  camera.release((*frame)->buffer);
  ASSERT_TRUE(fed.write(whole));
  frame = camera.wait_frame(1s);
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->integrity, FrameIntegrity::good);
}

TEST_F(LoopbackFault, a_slow_reader_sees_a_gap) {
  auto fed = feeder();
  V4l2LineCamera camera{{.node = node_}, clock_};
  ASSERT_TRUE(camera.open(config_of()));
  ASSERT_TRUE(camera.start());
  const auto whole = frame_of(fed, 7);
  ASSERT_TRUE(fed.write(whole));
  const auto first = camera.wait_frame(1s);
  ASSERT_TRUE(first && *first);
  camera.release((*first)->buffer);
  for (int i = 0; i < 9; ++i)
    ASSERT_TRUE(fed.write(whole));
  const auto next = camera.wait_frame(1s);
  ASSERT_TRUE(next && *next);
  EXPECT_EQ((*first)->sequence, 0U);
  EXPECT_EQ((*next)->sequence, 9U) << "the driver keeps the newest";
}

TEST_F(LoopbackFault, a_writer_that_ends_is_silence_and_one_that_comes_again_is_heard) {
  V4l2LineCamera camera{{.node = node_}, clock_};
  {
    auto fed = feeder();
    ASSERT_TRUE(camera.open(config_of()));
    ASSERT_TRUE(camera.start());
    ASSERT_TRUE(fed.write(frame_of(fed, 1)));
    const auto frame = camera.wait_frame(1s);
    ASSERT_TRUE(frame && *frame);
    camera.release((*frame)->buffer);
  }
  const auto silence = camera.wait_frame(50ms);
  ASSERT_TRUE(silence) << silence.error().message;
  EXPECT_FALSE(silence->has_value());
  auto again = feeder();
  ASSERT_TRUE(again.write(frame_of(again, 2)));
  const auto frame = camera.wait_frame(1s);
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->sequence, 1U);
}

TEST_F(LoopbackFault, opened_and_closed_200_times_nothing_leaks) {
  auto fed = feeder();
  V4l2LineCamera camera{{.node = node_}, clock_};
  const auto whole = frame_of(fed, 3);
  ResourceCount before;
  Holdings held;
  for (int cycle = 0; cycle < 205; ++cycle) {
    if (cycle == 5) { // what is allocated once is there
      held = Holdings::now();
      before = resources_in_use();
    }
    ASSERT_TRUE(camera.open(config_of())) << cycle;
    ASSERT_TRUE(camera.start()) << cycle;
    ASSERT_TRUE(fed.write(whole));
    const auto frame = camera.wait_frame(1s);
    ASSERT_TRUE(frame && *frame) << cycle;
    if (cycle % 2 == 0)
      camera.release((*frame)->buffer);
    if (cycle % 3 == 0)
      camera.stop();
    camera.close();
  }
  expect_no_leak(before);
  EXPECT_EQ(Holdings::now().mappings, held.mappings) << "of files and devices";
}

} // namespace
} // namespace octascope::tests
