// The line camera on a modelled driver under its whole contract, in virtual time and in real time.
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/v4l2/v4l2_line_camera.h"
#include "sim/clock/virtual_clock.h"
#include "tests/contract/line_camera_loans_contract.h"
#include "tests/hal/v4l2/modelled_driver.h"
#include "tests/support/fails_with.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::MonotonicClock;
using hal::linux_backend::V4l2LineCamera;
using sim::VirtualClock;

constexpr int frames = 6;

hal::LineCameraConfig small_config() {
  return {.format = {.samples_per_line = 32,
                     .lines_per_frame = 8,
                     .sample_type = hal::SampleType::u16,
                     .significant_bits = 12,
                     .right_shift = 0},
          .line_rate_hz = 4e3,
          .buffers = 4};
}

template <class ClockType> class ModelledBench final : public LineCameraBench {
public:
  hal::LineCamera& camera() override { return camera_; }
  hal::Clock& clock() override { return clock_; }
  bool time_is_exact() const override { return std::is_same_v<ClockType, VirtualClock>; }
  hal::LineCameraConfig config() const override { return small_config(); }
  void trigger() override { driver_.trigger(); }
  int frames_per_sweep() const override { return frames; }
  hal::Duration sweep_duration() const override {
    const hal::LineCameraConfig made = small_config();
    return frames * hal::from_seconds(made.format.lines_per_frame / made.line_rate_hz);
  }
  hal::Duration stamp_jitter() const override {
    return std::chrono::microseconds{1};
  } // stamps' unit
  bool can_unplug() const override { return true; }
  void unplug() override { driver_.unplug(); }
  void replug() override { driver_.replug(); }

private:
  ClockType clock_;
  ModelledDriver driver_{small_config(), frames, clock_};
  V4l2LineCamera camera_{{.node = ModelledDriver::node}, clock_};
};

const LineCameraCase in_virtual_time{
    "virtual_time", [] { return std::make_unique<ModelledBench<VirtualClock>>(); }};
const LineCameraCase in_real_time{"real_time",
                                  [] { return std::make_unique<ModelledBench<MonotonicClock>>(); }};

TEST(ModelledCamera, an_impossible_window_is_refused_before_anything_is_opened) {
  VirtualClock clock;
  V4l2LineCamera camera{{.node = "/dev/video-none", .window = {{0, 0, -1, 8}}}, clock};
  EXPECT_THAT(camera.open(small_config()), FailsWith(hal::ErrorCode::invalid_argument));
}

TEST(ModelledCamera, the_sequence_wraps_unseen) {
  VirtualClock clock;
  ModelledDriver driver{small_config(), 20, clock}; // begins 8 frames before the wrap
  V4l2LineCamera camera{{.node = ModelledDriver::node}, clock};
  ASSERT_TRUE(camera.open(small_config()));
  ASSERT_TRUE(camera.start());
  driver.trigger();
  for (std::uint64_t i = 0; i < 20; ++i) {
    const auto frame = camera.wait_frame(std::chrono::seconds{1});
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->sequence, i);
    camera.release((*frame)->buffer);
  }
}

} // namespace

INSTANTIATE_TEST_SUITE_P(V4l2, LineCameraContract, testing::Values(in_virtual_time, in_real_time),
                         NameOfCase{});
INSTANTIATE_TEST_SUITE_P(V4l2, LineCameraLoansContract,
                         testing::Values(in_virtual_time, in_real_time), NameOfCase{});

} // namespace octascope::tests
