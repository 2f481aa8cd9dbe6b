// What every hal::LineCamera must do, sentence by sentence of its header. A backend brings a
// LineCameraBench and instantiates LineCameraContract with it (tests/sim/sim_line_camera_contract_
// test.cpp shows how); loans, disconnects and threads are in line_camera_loans_contract.h.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/line_camera.h"
#include "tests/contract/contract_case.h"

namespace octascope::tests {

// A camera in its surroundings. A fresh bench has a closed camera that is plugged in.
class LineCameraBench {
public:
  virtual ~LineCameraBench() = default;

  // Why the surroundings cannot be had here (a driver is missing); empty when they are there.
  virtual std::string missing() const { return {}; }

  virtual hal::LineCamera& camera() = 0;
  virtual hal::Clock& clock() = 0;

  // True when time moves only by sleeping, so that waits can be compared exactly.
  virtual bool time_is_exact() const { return false; }

  // How far apart the time stamps of a frame and what they tell may be.
  virtual hal::Duration stamp_jitter() const { return {}; }

  // False where the driver writes into buffers that are on loan, against the rules.
  virtual bool driver_keeps_loans() const { return true; }

  // A configuration that works, with fewer buffers than a sweep has frames.
  virtual hal::LineCameraConfig config() const = 0;

  // One pulse of the galvo trigger; the sweep it starts has so many frames and takes so long.
  virtual void trigger() = 0;
  virtual int frames_per_sweep() const = 0;
  virtual hal::Duration sweep_duration() const = 0;

  virtual bool can_unplug() const { return false; }
  virtual void unplug() {}
  virtual void replug() {}
};

using LineCameraCase = ContractCase<LineCameraBench>;

class LineCameraContract : public testing::TestWithParam<LineCameraCase> {
protected:
  using MaybeFrame = hal::Result<std::optional<hal::LineFrame>>;

  void SetUp() override {
    if (const std::string missing = bench_->missing(); !missing.empty())
      GTEST_SKIP() << missing;
  }

  // Longer than a sweep by far, for waits that end early when all is well.
  hal::Duration long_enough() const { return bench_->sweep_duration() * 50; }

  // With buffers for several sweeps, so that no busy machine makes the driver drop frames.
  void open_and_start() {
    hal::LineCameraConfig config = bench_->config();
    config.buffers = 4 * bench_->frames_per_sweep();
    ASSERT_TRUE(camera_.open(config));
    ASSERT_TRUE(camera_.start());
  }

  void open_and_start_with_few_buffers() {
    ASSERT_LT(bench_->config().buffers, bench_->frames_per_sweep()) << "the bench is too generous";
    ASSERT_TRUE(camera_.open(bench_->config()));
    ASSERT_TRUE(camera_.start());
  }

  hal::LineFrame expect_frame() {
    const MaybeFrame frame = camera_.wait_frame(long_enough());
    EXPECT_TRUE(frame.has_value()) << (frame ? "" : frame.error().message);
    EXPECT_TRUE(frame && frame->has_value()) << "no frame came";
    return frame ? frame->value_or(hal::LineFrame{}) : hal::LineFrame{};
  }

  void expect_no_frame(hal::Duration timeout) {
    const MaybeFrame frame = camera_.wait_frame(timeout);
    ASSERT_TRUE(frame.has_value()) << frame.error().message;
    EXPECT_FALSE(frame->has_value());
  }

  std::unique_ptr<LineCameraBench> bench_ = GetParam().make();
  hal::LineCamera& camera_ = bench_->camera();
  hal::Clock& clock_ = bench_->clock();
};

TEST_P(LineCameraContract, tells_which_camera_it_is_from_the_first_open_on) {
  EXPECT_EQ(camera_.identity(), "");
  ASSERT_TRUE(camera_.open(bench_->config()));
  const std::string identity = camera_.identity();
  EXPECT_NE(identity, "");
  camera_.close();
  EXPECT_EQ(camera_.identity(), identity) << "until another one is opened";
  ASSERT_TRUE(camera_.open(bench_->config()));
  EXPECT_EQ(camera_.identity(), identity);
}

TEST_P(LineCameraContract, walks_through_its_states) {
  EXPECT_FALSE(camera_.backend().empty());
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  ASSERT_TRUE(camera_.open(bench_->config()));
  EXPECT_EQ(camera_.state(), hal::DeviceState::ready);
  ASSERT_TRUE(camera_.start());
  EXPECT_EQ(camera_.state(), hal::DeviceState::streaming);
  camera_.stop();
  EXPECT_EQ(camera_.state(), hal::DeviceState::ready);
  ASSERT_TRUE(camera_.start());
  camera_.close();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
}

TEST_P(LineCameraContract, refuses_calls_in_the_wrong_order) {
  using hal::ErrorCode;
  expect_fault(camera_.start(), ErrorCode::invalid_argument);
  expect_fault(camera_.wait_frame({}), ErrorCode::invalid_argument);
  camera_.stop();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);

  ASSERT_TRUE(camera_.open(bench_->config()));
  expect_fault(camera_.open(bench_->config()), ErrorCode::invalid_argument);
  expect_fault(camera_.wait_frame({}), ErrorCode::invalid_argument);
  camera_.stop();
  EXPECT_EQ(camera_.state(), hal::DeviceState::ready);

  ASSERT_TRUE(camera_.start());
  expect_fault(camera_.start(), ErrorCode::invalid_argument);
  expect_fault(camera_.open(bench_->config()), ErrorCode::invalid_argument);
  EXPECT_EQ(camera_.state(), hal::DeviceState::streaming);
  bench_->trigger();
  EXPECT_EQ(expect_frame().sequence, 0U) << "the refused calls did no harm";
}

TEST_P(LineCameraContract, closes_from_every_state_and_opens_again) {
  camera_.close();
  ASSERT_TRUE(camera_.open(bench_->config()));
  camera_.close();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  open_and_start();
  camera_.close();
  camera_.close();
  EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  open_and_start();
  bench_->trigger();
  expect_frame();
}

TEST_P(LineCameraContract, refuses_impossible_configurations_and_stays_absent) {
  const auto refused = [&](auto change) {
    hal::LineCameraConfig config = bench_->config();
    change(config);
    expect_fault(camera_.open(config), hal::ErrorCode::invalid_argument);
    EXPECT_EQ(camera_.state(), hal::DeviceState::absent);
  };
  refused([](hal::LineCameraConfig& c) { c.buffers = 0; });
  refused([](hal::LineCameraConfig& c) { c.buffers = -1; });
  refused([](hal::LineCameraConfig& c) { c.line_rate_hz = 0; });
  refused([](hal::LineCameraConfig& c) { c.line_rate_hz = -1; });
  refused(
      [](hal::LineCameraConfig& c) { c.line_rate_hz = std::numeric_limits<double>::quiet_NaN(); });
  refused([](hal::LineCameraConfig& c) { c.format.lines_per_frame = 0; });
  refused([](hal::LineCameraConfig& c) { c.format.samples_per_line = 0; });
  refused([](hal::LineCameraConfig& c) { c.format.significant_bits = 99; });
  EXPECT_TRUE(camera_.open(bench_->config())) << "refusals leave no trace";
}

TEST_P(LineCameraContract, without_a_trigger_no_frame_comes_and_the_wait_is_kept) {
  open_and_start();
  const hal::TimePoint before = clock_.now();
  const hal::Duration timeout = std::chrono::milliseconds{20};
  expect_no_frame(timeout);
  EXPECT_GE(clock_.now() - before, timeout);
  if (bench_->time_is_exact()) {
    EXPECT_EQ(clock_.now() - before, timeout);
  }
  EXPECT_EQ(camera_.state(), hal::DeviceState::streaming) << "the stream goes on";
  expect_no_frame({});
  expect_no_frame(std::chrono::milliseconds{-5});
}

TEST_P(LineCameraContract, a_trigger_brings_one_sweep_of_good_frames_in_order) {
  open_and_start();
  const hal::TimePoint triggered = clock_.now();
  bench_->trigger();
  hal::TimePoint last_line = triggered;
  for (int f = 0; f < bench_->frames_per_sweep(); ++f) {
    const hal::LineFrame frame = expect_frame();
    EXPECT_EQ(frame.sequence, static_cast<std::uint64_t>(f));
    EXPECT_EQ(frame.integrity, hal::FrameIntegrity::good);
    EXPECT_EQ(frame.bytes.size(), bench_->config().format.frame_bytes());
    EXPECT_GE(frame.first_line, last_line - bench_->stamp_jitter()) << "exposures do not overlap";
    EXPECT_GE(frame.last_line, frame.first_line);
    EXPECT_LE(frame.last_line, clock_.now()) << "nothing is handed out before its light came";
    last_line = frame.last_line;
    camera_.release(frame.buffer);
  }
  expect_no_frame(bench_->sweep_duration());
}

TEST_P(LineCameraContract, a_wait_without_end_ends_with_a_frame) {
  open_and_start();
  bench_->trigger();
  const MaybeFrame frame = camera_.wait_frame(hal::Duration::max());
  ASSERT_TRUE(frame.has_value()) << frame.error().message;
  EXPECT_TRUE(frame->has_value());
}

TEST_P(LineCameraContract, lines_keep_the_line_rate) {
  open_and_start();
  bench_->trigger();
  const hal::LineFrame first = expect_frame();
  const hal::LineFrame second = expect_frame();
  const hal::LineCameraConfig config = bench_->config();
  const int lines = config.format.lines_per_frame;
  const double tolerance_s = 0.02 / config.line_rate_hz + 2e-9;
  const double jitter_s = hal::to_seconds(bench_->stamp_jitter());
  EXPECT_NEAR(hal::to_seconds(second.first_line - first.first_line), lines / config.line_rate_hz,
              tolerance_s + jitter_s);
  EXPECT_NEAR(hal::to_seconds(first.last_line - first.first_line),
              (lines - 1) / config.line_rate_hz, tolerance_s);
}

TEST_P(LineCameraContract, sequence_begins_anew_at_each_start_and_unfetched_frames_are_gone) {
  open_and_start();
  bench_->trigger();
  expect_frame();
  clock_.sleep_for(bench_->sweep_duration() * 2);
  camera_.stop();
  ASSERT_TRUE(camera_.start());
  expect_no_frame(bench_->sweep_duration());
  const hal::TimePoint triggered = clock_.now();
  bench_->trigger();
  const hal::LineFrame frame = expect_frame();
  EXPECT_EQ(frame.sequence, 0U);
  EXPECT_GE(frame.first_line, triggered - bench_->stamp_jitter());
}

} // namespace octascope::tests
