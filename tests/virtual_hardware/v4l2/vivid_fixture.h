// A line camera on vivid, fresh for each test.
#pragma once

#include <chrono>
#include <optional>

#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "tests/virtual_hardware/v4l2/vivid.h"

namespace octascope::tests {

class VividTest : public testing::Test {
protected:
  void SetUp() override {
    if (!vivid_)
      GTEST_SKIP() << "no vivid device: `modprobe vivid`, or run this in the bench's kernel";
    vivid_->reset();
  }

  void TearDown() override {
    camera_.close();
    if (vivid_)
      vivid_->reset();
  }

  // At the rate of its 60 pictures a second.
  static hal::LineCameraConfig usual_config() {
    return {.format = {.samples_per_line = 1024,
                       .lines_per_frame = 379,
                       .sample_type = hal::SampleType::u16,
                       .significant_bits = 12,
                       .right_shift = 0},
            .line_rate_hz = 379 * 60.0,
            .buffers = 8};
  }

  hal::linux_backend::V4l2CameraOptions usual_options() const {
    hal::linux_backend::V4l2CameraOptions options;
    options.node = vivid_ ? vivid_->node() : "/dev/video-none";
    options.input = Vivid::any_size_input;
    return options;
  }

  void open_and_start(const hal::LineCameraConfig& config) {
    const auto opened = camera_.open(config);
    ASSERT_TRUE(opened) << opened.error().message;
    const auto started = camera_.start();
    ASSERT_TRUE(started) << started.error().message;
  }

  hal::LineFrame next_frame() {
    const auto frame = camera_.wait_frame(std::chrono::seconds{2});
    EXPECT_TRUE(frame) << frame.error().message;
    EXPECT_TRUE(frame && *frame) << "no frame came";
    return frame ? frame->value_or(hal::LineFrame{}) : hal::LineFrame{};
  }

  std::optional<Vivid> vivid_ = Vivid::find();
  hal::linux_backend::MonotonicClock clock_;
  hal::linux_backend::V4l2LineCamera camera_{usual_options(), clock_};
};

} // namespace octascope::tests
