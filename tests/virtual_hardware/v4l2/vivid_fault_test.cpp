// Every fault that vivid can inject: told, survived, and over when it is over.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/linux/v4l2/video_nodes.h"
#include "tests/virtual_hardware/support/resource_count.h"
#include "tests/virtual_hardware/support/syscall_faults.h"
#include "tests/virtual_hardware/v4l2/vivid_fixture.h"

namespace octascope::tests {
namespace {

using namespace hal;
using namespace hal::linux_backend;
using namespace std::chrono_literals;
using testing::HasSubstr;

class VividFault : public VividTest {
protected:
  // Frames come, good ones.
  void expect_health() {
    const LineFrame frame = next_frame();
    EXPECT_EQ(frame.integrity, FrameIntegrity::good);
    camera_.release(frame.buffer);
  }

  template <class R> static void expect_fault(const R& result, ErrorCode fault) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, fault) << result.error().message;
    std::printf("  %s\n", result.error().message.c_str());
  }
};

TEST_F(VividFault, a_flagged_frame_is_handed_out_as_corrupted) {
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  expect_health();
  ASSERT_TRUE(vivid_->set("Inject V4L2_BUF_FLAG_ERROR"));
  int corrupted = 0;
  for (int i = 0; i < 8; ++i) {
    const LineFrame frame = next_frame();
    corrupted += frame.integrity == FrameIntegrity::corrupted ? 1 : 0;
    camera_.release(frame.buffer);
  }
  EXPECT_EQ(corrupted, 1);
  expect_health();
}

TEST_F(VividFault, dropped_buffers_are_gaps_in_the_sequence) {
  ASSERT_TRUE(vivid_->set("Percentage of Dropped Buffers", 60));
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  std::uint64_t last = 0;
  for (int i = 0; i < 20; ++i) {
    const LineFrame frame = next_frame();
    EXPECT_TRUE(i == 0 || frame.sequence > last);
    last = frame.sequence;
    camera_.release(frame.buffer);
  }
  EXPECT_GT(last, 25U) << "of 20 frames in 50, some 30 were dropped";
  ASSERT_TRUE(vivid_->set("Percentage of Dropped Buffers", 0));
  expect_health();
}

TEST_F(VividFault, a_camera_that_drops_all_is_silent_and_comes_back) {
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  expect_health();
  ASSERT_TRUE(vivid_->set("Percentage of Dropped Buffers", 100));
  clock_.sleep_for(50ms);
  while (const auto waiting = *camera_.wait_frame({}))
    camera_.release(waiting->buffer);
  const auto silence = camera_.wait_frame(100ms);
  ASSERT_TRUE(silence) << silence.error().message;
  EXPECT_FALSE(silence->has_value());
  ASSERT_TRUE(vivid_->set("Percentage of Dropped Buffers", 0));
  expect_health();
}

TEST_F(VividFault, a_disconnect_is_told_and_loans_stay_readable) {
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  const LineFrame loan = next_frame();
  const std::vector<std::byte> copy{loan.bytes.begin(), loan.bytes.end()};
  FileDescriptor held = vivid_->hold();
  ASSERT_TRUE(vivid_->set("Disconnect"));
  expect_fault(camera_.wait_frame(2s), ErrorCode::disconnected);
  EXPECT_EQ(camera_.state(), DeviceState::failed);
  EXPECT_TRUE(std::ranges::equal(loan.bytes, copy));
  camera_.release(loan.buffer);
  expect_fault(camera_.wait_frame({}), ErrorCode::disconnected);
  expect_fault(camera_.start(), ErrorCode::disconnected);
  camera_.stop();
  EXPECT_EQ(camera_.state(), DeviceState::failed);
  camera_.close();
  expect_fault(camera_.open(usual_config()), ErrorCode::absent);
  EXPECT_EQ(camera_.state(), DeviceState::absent);
  held.reset(); // the driver comes back when nobody has it open
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  EXPECT_EQ(next_frame().sequence, 0U);
}

TEST_F(VividFault, a_disconnect_before_start_is_told_by_start) {
  ASSERT_TRUE(camera_.open(usual_config()));
  ASSERT_TRUE(vivid_->set("Disconnect"));
  expect_fault(camera_.start(), ErrorCode::disconnected);
  EXPECT_EQ(camera_.state(), DeviceState::failed);
  camera_.close();
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  expect_health();
}

TEST_F(VividFault, a_refused_reqbufs_fails_open_and_leaves_nothing) {
  const Holdings before = Holdings::now();
  ASSERT_TRUE(vivid_->set("Inject VIDIOC_REQBUFS Error"));
  expect_fault(camera_.open(usual_config()), ErrorCode::unsupported);
  EXPECT_EQ(camera_.state(), DeviceState::absent);
  EXPECT_TRUE(Holdings::now() == before);
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  expect_health();
}

TEST_F(VividFault, a_refused_qbuf_fails_start_and_the_next_start_does) {
  ASSERT_TRUE(camera_.open(usual_config()));
  ASSERT_TRUE(vivid_->set("Inject VIDIOC_QBUF Error"));
  expect_fault(camera_.start(), ErrorCode::unsupported);
  EXPECT_EQ(camera_.state(), DeviceState::ready);
  ASSERT_TRUE(camera_.start());
  expect_health();
}

TEST_F(VividFault, a_buffer_refused_while_streaming_is_queued_later) {
  LineCameraConfig config = usual_config();
  config.buffers = 4;
  ASSERT_NO_FATAL_FAILURE(open_and_start(config));
  const LineFrame frame = next_frame();
  ASSERT_TRUE(vivid_->set("Inject VIDIOC_QBUF Error"));
  camera_.release(frame.buffer);
  EXPECT_EQ(camera_.tally().failed_returns, 1U);
  // All four are there again: four can be on loan at once.
  std::vector<LineFrame> loans;
  for (int i = 0; i < config.buffers; ++i)
    loans.push_back(next_frame());
  for (const LineFrame& loan : loans)
    camera_.release(loan.buffer);
  EXPECT_EQ(camera_.tally().failed_returns, 1U);
  expect_health();
}

TEST_F(VividFault, a_refused_streamon_fails_start_and_the_next_start_does) {
  ASSERT_TRUE(camera_.open(usual_config()));
  ASSERT_TRUE(vivid_->set("Inject VIDIOC_STREAMON Error"));
  expect_fault(camera_.start(), ErrorCode::unsupported);
  EXPECT_EQ(camera_.state(), DeviceState::ready);
  ASSERT_TRUE(camera_.start());
  expect_health();
}

TEST_F(VividFault, a_fatal_error_of_the_stream_fails_it_until_it_is_opened_again) {
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  expect_health();
  ASSERT_TRUE(vivid_->set("Inject Fatal Streaming Error"));
  expect_fault(camera_.wait_frame(2s), ErrorCode::disconnected);
  EXPECT_EQ(camera_.state(), DeviceState::failed);
  camera_.close();
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  expect_health();
}

TEST_F(VividFault, the_sequence_goes_on_over_the_32_bit_wrap) {
  ASSERT_TRUE(vivid_->set("Wrap Sequence Number", 1)); // begins 128 frames before the wrap
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  std::uint64_t last = 0;
  for (int i = 0; last < 135; ++i) {
    const LineFrame frame = next_frame();
    ASSERT_TRUE(i == 0 ? frame.sequence == 0 : frame.sequence > last);
    ASSERT_LT(frame.sequence, last + 60);
    last = frame.sequence;
    camera_.release(frame.buffer);
  }
}

TEST_F(VividFault, a_stamp_that_cannot_be_is_replaced_by_our_clock_and_counted) {
  for (const int kind : {1, 2}) { // 64 bits, 32 bits
    SCOPED_TRACE(kind);
    ASSERT_TRUE(vivid_->set("Wrap Timestamp", kind));
    ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
    const std::uint64_t before = camera_.tally().own_stamps;
    const LineFrame frame = next_frame();
    EXPECT_EQ(camera_.tally().own_stamps, before + 1);
    EXPECT_TRUE(frame.timed_by_host);
    EXPECT_LE(frame.last_line, clock_.now());
    EXPECT_LT(clock_.now() - frame.first_line, 1s);
    camera_.close();
  }
}

TEST_F(VividFault, two_faults_at_once_are_both_told) {
  ASSERT_TRUE(vivid_->set("Wrap Timestamp", 2));
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  const std::uint64_t stamps = camera_.tally().own_stamps;
  ASSERT_TRUE(vivid_->set("Inject V4L2_BUF_FLAG_ERROR"));
  bool corrupted = false;
  for (int i = 0; i < 8; ++i) {
    const LineFrame frame = next_frame();
    corrupted = corrupted || frame.integrity == FrameIntegrity::corrupted;
    camera_.release(frame.buffer);
  }
  EXPECT_TRUE(corrupted);
  EXPECT_EQ(camera_.tally().own_stamps, stamps + 8);
}

TEST_F(VividFault, a_camera_in_use_is_busy_and_free_afterwards) {
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  V4l2LineCamera second{usual_options(), clock_};
  const auto refused = second.open(usual_config());
  expect_fault(refused, ErrorCode::busy);
  EXPECT_THAT(refused.error().message, HasSubstr("fuser"));
  expect_health(); // the first is not disturbed
  camera_.close();
  EXPECT_TRUE(second.open(usual_config()));
}

TEST_F(VividFault, a_camera_without_permission_says_what_to_do) {
  if (::geteuid() != 0)
    GTEST_SKIP() << "only root can become somebody without permission";
  ASSERT_EQ(::seteuid(65534), 0);
  const auto denied = camera_.open(usual_config());
  V4l2LineCamera any{{}, clock_};
  const auto none = any.open(usual_config());
  ASSERT_EQ(::seteuid(0), 0);
  expect_fault(denied, ErrorCode::denied);
  EXPECT_THAT(denied.error().message, HasSubstr("usermod"));
  expect_fault(none, ErrorCode::denied);
  ASSERT_NO_FATAL_FAILURE(open_and_start(usual_config()));
  expect_health();
}

TEST_F(VividFault, unplugged_and_plugged_200_times_nothing_leaks) {
  ResourceCount before;
  Holdings held;
  LineCameraConfig config = usual_config();
  config.format.samples_per_line = 256;
  config.format.lines_per_frame = 32;
  for (int cycle = 0; cycle < 205; ++cycle) {
    if (cycle == 5) { // what is allocated once is there
      held = Holdings::now();
      before = resources_in_use();
    }
    ASSERT_NO_FATAL_FAILURE(open_and_start(config)) << cycle;
    const LineFrame loan = next_frame();
    ASSERT_TRUE(vivid_->set("Disconnect"));
    while (camera_.wait_frame(2s)) {
    }
    if (cycle % 2 == 0)
      camera_.release(loan.buffer);
    camera_.close();
    ASSERT_FALSE(HasFailure()) << cycle;
  }
  expect_no_leak(before);
  EXPECT_EQ(Holdings::now().mappings, held.mappings) << "of files and devices";
}

} // namespace
} // namespace octascope::tests
