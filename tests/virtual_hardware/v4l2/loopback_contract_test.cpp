// The line camera's contract, through the kernel: a feeder writes a sweep into v4l2loopback for
// each trigger. Its driver cannot be unplugged and does not keep loans; vivid and the driver
// modelled in tests/hal/v4l2 can and do.
#include <algorithm>
#include <thread>
#include <vector>

#include "hal/linux/monotonic_clock.h"
#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "tests/contract/line_camera_contract.h"
#include "tests/contract/line_camera_loans_contract.h"
#include "tests/virtual_hardware/support/loopback_feeder.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using hal::linux_backend::V4l2LineCamera;

class LoopbackBench final : public LineCameraBench {
public:
  LoopbackBench() {
    hal::linux_backend::V4l2CameraOptions options;
    if (const auto node = LoopbackFeeder::find()) {
      auto feeder = LoopbackFeeder::open(*node, samples, lines);
      EXPECT_TRUE(feeder) << feeder.error().message;
      if (feeder)
        feeder_ = std::make_unique<LoopbackFeeder>(std::move(*feeder));
      options.node = *node;
    }
    camera_ = std::make_unique<V4l2LineCamera>(options, clock_);
  }
  ~LoopbackBench() override { end_sweep(); }

  std::string missing() const override {
    return feeder_ ? ""
                   : "no v4l2loopback node: load the module, or run this in the bench's kernel";
  }

  hal::LineCamera& camera() override { return *camera_; }
  hal::Clock& clock() override { return clock_; }

  hal::LineCameraConfig config() const override {
    return {.format = {.samples_per_line = samples,
                       .lines_per_frame = lines,
                       .sample_type = hal::SampleType::u16,
                       .significant_bits = 12,
                       .right_shift = 0},
            .line_rate_hz = lines * 1e9 / static_cast<double>(frame_period.count()),
            .buffers = 4};
  }

  void trigger() override {
    end_sweep();
    sweep_ = std::thread{[this, armed = clock_.now()] {
      std::vector<std::byte> frame(feeder_->frame_bytes());
      hal::TimePoint next = armed + frame_period;
      for (int f = 0; f < frames; ++f) {
        frame.assign(frame.size(), static_cast<std::byte>(f));
        clock_.sleep_until(next);
        EXPECT_TRUE(feeder_->write(frame));
        // Never two at once, however late: the driver drops what a reader has not fetched.
        next = std::max(next, clock_.now() - frame_period / 2) + frame_period;
      }
    }};
  }
  int frames_per_sweep() const override { return frames; }
  hal::Duration sweep_duration() const override { return frames * frame_period; }

  // One processor: the feeder's thread may have to wait for ours, and the kernel for the host's.
  hal::Duration stamp_jitter() const override { return 5 * frame_period; }
  bool driver_keeps_loans() const override { return false; }

private:
  static constexpr int samples = 256;
  static constexpr int lines = 64;
  static constexpr int frames = 6;
  static constexpr hal::Duration frame_period = 8ms;

  void end_sweep() {
    if (sweep_.joinable())
      sweep_.join();
  }

  hal::linux_backend::MonotonicClock clock_;
  std::unique_ptr<LoopbackFeeder> feeder_;
  std::unique_ptr<V4l2LineCamera> camera_;
  std::thread sweep_;
};

const LineCameraCase loopback{"v4l2loopback", [] { return std::make_unique<LoopbackBench>(); }};

} // namespace

INSTANTIATE_TEST_SUITE_P(V4l2, LineCameraContract, testing::Values(loopback), NameOfCase{});
INSTANTIATE_TEST_SUITE_P(V4l2, LineCameraLoansContract, testing::Values(loopback), NameOfCase{});

} // namespace octascope::tests
