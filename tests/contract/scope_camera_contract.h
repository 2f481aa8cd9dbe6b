// What hal/scope_camera.h promises, as tests for any implementation:
//
//   INSTANTIATE_TEST_SUITE_P(Sim, ScopeCameraContract, testing::Values(make_rig_of_the_twin));
//
// A camera that cannot be unplugged by a program leaves `unplug` and `replug` empty; those tests
// are then skipped.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "hal/scope_camera.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {

struct ScopeCameraRig {
  std::shared_ptr<void> keeper; // owns what the camera borrows
  hal::Clock* clock = nullptr;
  std::unique_ptr<hal::ScopeCamera> camera;
  std::function<void()> unplug;
  std::function<void()> replug;
  bool keeps_rate = true; // false: this camera has a rate of its own, whatever is wanted
};

class ScopeCameraContract : public testing::TestWithParam<std::function<ScopeCameraRig()>> {
protected:
  void open_and_start() {
    const auto opened = camera_.open({});
    ASSERT_TRUE(opened) << opened.error().message;
    const auto started = camera_.start();
    ASSERT_TRUE(started) << started.error().message;
  }
  // The next frame, or a failed test and an empty frame.
  hal::ScopeFrame next_frame() {
    const auto frame = camera_.wait_frame(patience);
    if (!frame || !*frame) {
      ADD_FAILURE() << (frame ? "no frame in time" : frame.error().message);
      return {};
    }
    return **frame;
  }
  static std::size_t smallest_row(const hal::ScopeFrame& frame) {
    const auto width = static_cast<std::size_t>(frame.width);
    switch (frame.format) {
    case hal::PixelFormat::rgb8: return 3 * width;
    case hal::PixelFormat::rgba8: return 4 * width;
    case hal::PixelFormat::yuyv: return 2 * width;
    case hal::PixelFormat::nv12: return width;
    }
    return 0;
  }

  static constexpr hal::Duration patience = std::chrono::seconds{2};
  ScopeCameraRig rig_ = GetParam()();
  hal::ScopeCamera& camera_ = *rig_.camera;
};

TEST_P(ScopeCameraContract, states_lead_from_absent_to_streaming_and_back) {
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  EXPECT_FALSE(camera_.backend().empty());
  ASSERT_TRUE(camera_.open({}));
  EXPECT_EQ(camera_.state(), hal::DeviceState::ready);
  ASSERT_TRUE(camera_.start());
  EXPECT_EQ(camera_.state(), hal::DeviceState::streaming);
  camera_.stop();
  EXPECT_EQ(camera_.state(), hal::DeviceState::ready);
  ASSERT_TRUE(camera_.start());
  camera_.close();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  ASSERT_TRUE(camera_.open({})) << "it can be opened again";
  camera_.close();
}

TEST_P(ScopeCameraContract, calls_out_of_order_are_errors_and_change_nothing) {
  EXPECT_FALSE(camera_.start());
  EXPECT_FALSE(camera_.wait_frame(hal::Duration::zero()));
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  camera_.stop();
  camera_.close();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  ASSERT_TRUE(camera_.open({}));
  EXPECT_FALSE(camera_.open({}));
  EXPECT_FALSE(camera_.wait_frame(hal::Duration::zero()));
  EXPECT_EQ(camera_.state(), hal::DeviceState::ready);
}

TEST_P(ScopeCameraContract, an_impossible_request_is_an_invalid_argument) {
  for (const hal::ScopeCameraConfig& wanted :
       {hal::ScopeCameraConfig{0, 480, 30}, hal::ScopeCameraConfig{640, -1, 30},
        hal::ScopeCameraConfig{640, 480, 0}, hal::ScopeCameraConfig{640, 480, -30}}) {
    const auto opened = camera_.open(wanted);
    ASSERT_THAT(opened, FailsWith(hal::ErrorCode::invalid_argument));
    EXPECT_FALSE(opened.error().message.empty());
    EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  }
}

TEST_P(ScopeCameraContract, frames_say_what_they_are) {
  open_and_start();
  const hal::ScopeFrame frame = next_frame();
  EXPECT_GE(frame.buffer, 0);
  EXPECT_GT(frame.width, 0);
  EXPECT_GT(frame.height, 0);
  EXPECT_GE(static_cast<std::size_t>(frame.stride_bytes), smallest_row(frame));
  EXPECT_GE(frame.pixels.size(), static_cast<std::size_t>(frame.stride_bytes) *
                                         static_cast<std::size_t>(frame.height - 1) +
                                     smallest_row(frame));
  EXPECT_LE(frame.time, rig_.clock->now());
  camera_.release(frame.buffer);
}

TEST_P(ScopeCameraContract, sequence_and_time_rise_and_loans_stay_as_they_were) {
  open_and_start();
  hal::ScopeFrame last = next_frame();
  std::vector<std::byte> copy(last.pixels.begin(), last.pixels.end());
  for (int i = 0; i < 10; ++i) {
    const hal::ScopeFrame frame = next_frame();
    EXPECT_NE(frame.buffer, last.buffer) << "it is still on loan";
    EXPECT_GT(frame.sequence, last.sequence);
    EXPECT_GT(frame.time, last.time);
    EXPECT_TRUE(std::equal(copy.begin(), copy.end(), last.pixels.begin()));
    camera_.release(last.buffer);
    last = frame;
    copy.assign(last.pixels.begin(), last.pixels.end());
  }
  camera_.stop();
  EXPECT_TRUE(std::equal(copy.begin(), copy.end(), last.pixels.begin()))
      << "loans outlive the stream";
  camera_.release(last.buffer);
}

TEST_P(ScopeCameraContract, frames_come_at_about_the_requested_rate) {
  if (!rig_.keeps_rate)
    GTEST_SKIP() << "this camera has a rate of its own";
  open_and_start();
  const hal::ScopeFrame first = next_frame();
  camera_.release(first.buffer);
  hal::ScopeFrame frame = first;
  for (int i = 0; i < 15; ++i) {
    frame = next_frame();
    camera_.release(frame.buffer);
  }
  const double period_s = hal::to_seconds(frame.time - first.time) /
                          static_cast<double>(frame.sequence - first.sequence);
  EXPECT_NEAR(period_s, 1.0 / 30, 0.2 / 30);
}

TEST_P(ScopeCameraContract, with_all_buffers_on_loan_the_wait_ends_empty_and_the_stream_goes_on) {
  open_and_start();
  std::vector<int> loans;
  for (int i = 0; i < 256; ++i) {
    // A camera that is merely slow, on a machine that others use, must not look like one that has
    // nothing to fill.
    const auto frame = camera_.wait_frame(patience);
    ASSERT_TRUE(frame) << frame.error().message;
    if (!*frame)
      break;
    loans.push_back((*frame)->buffer);
  }
  ASSERT_LT(loans.size(), 256U) << "no camera has that many buffers";
  EXPECT_EQ(camera_.state(), hal::DeviceState::streaming);

  const hal::TimePoint before = rig_.clock->now();
  const auto none = camera_.wait_frame(std::chrono::milliseconds{1});
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_FALSE(*none) << "there is no buffer for one";
  EXPECT_LT(rig_.clock->now() - before, std::chrono::milliseconds{500}) << "a wait keeps its limit";
  EXPECT_EQ(camera_.state(), hal::DeviceState::streaming);

  camera_.release(loans.front());
  const hal::ScopeFrame frame = next_frame();
  EXPECT_EQ(frame.buffer, loans.front());
}

TEST_P(ScopeCameraContract, releases_of_what_is_not_on_loan_are_ignored) {
  camera_.release(0);
  open_and_start();
  for (const int strange : {-1, 3, 1 << 20})
    camera_.release(strange);
  const hal::ScopeFrame frame = next_frame();
  camera_.release(frame.buffer);
  camera_.release(frame.buffer);
  camera_.release(next_frame().buffer);
}

TEST_P(ScopeCameraContract, unplugged_it_fails_and_comes_back_after_close_and_open) {
  if (!rig_.unplug)
    GTEST_SKIP() << "this camera has no cable that a program can pull";
  open_and_start();
  const hal::ScopeFrame loan = next_frame();
  rig_.unplug();
  // Frames that were made before may still be delivered.
  auto frame = camera_.wait_frame(patience);
  for (int i = 0; i < 100 && frame; ++i)
    frame = camera_.wait_frame(patience);
  ASSERT_THAT(frame, FailsWith(hal::ErrorCode::disconnected));
  EXPECT_FALSE(frame.error().message.empty());
  EXPECT_EQ(camera_.state(), hal::DeviceState::failed);
  EXPECT_FALSE(camera_.wait_frame(hal::Duration::zero()));
  camera_.release(loan.buffer); // void, and ignored

  camera_.close();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  EXPECT_THAT(camera_.open({}), FailsWith(hal::ErrorCode::absent));
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);

  rig_.replug();
  open_and_start();
  camera_.release(next_frame().buffer);
}

TEST_P(ScopeCameraContract, replugged_but_not_reopened_it_stays_failed) {
  if (!rig_.unplug)
    GTEST_SKIP() << "this camera has no cable that a program can pull";
  open_and_start();
  rig_.unplug();
  auto frame = camera_.wait_frame(patience);
  for (int i = 0; i < 100 && frame; ++i)
    frame = camera_.wait_frame(patience);
  rig_.replug();
  EXPECT_FALSE(camera_.wait_frame(patience));
  EXPECT_EQ(camera_.state(), hal::DeviceState::failed);
}

} // namespace octascope::tests
