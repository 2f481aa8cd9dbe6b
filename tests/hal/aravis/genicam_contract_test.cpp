// The GenICam line camera under its whole contract, against Aravis's own camera on the loopback.
#include "hal/linux/aravis/genicam_camera.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/contract/line_camera_contract.h"
#include "tests/contract/line_camera_loans_contract.h"
#include "tests/hal/aravis/fake_camera.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

class LoopbackGenicamBench final : public LineCameraBench {
public:
  std::string missing() const override {
    return fake_.runs() ? "" : "Aravis's fake camera has no loopback to run on";
  }
  hal::LineCamera& camera() override { return *camera_; }
  hal::Clock& clock() override { return clock_; }
  hal::LineCameraConfig config() const override {
    return {.format = {.samples_per_line = 256,
                       .lines_per_frame = 64,
                       .sample_type = hal::SampleType::u16,
                       .significant_bits = 12,
                       .right_shift = 0},
            .line_rate_hz = 64e3, // a frame takes a millisecond, as the fake camera's
            .buffers = 4};
  }
  void trigger() override { fake_.trigger(frames); }
  int frames_per_sweep() const override { return frames; }
  // The fake camera sees that it shall stream after up to 100 ms; the rest is for a busy machine.
  hal::Duration sweep_duration() const override { return 300ms; }
  hal::Duration stamp_jitter() const override { return 150ms; }
  bool can_unplug() const override { return true; }
  void unplug() override { fake_.unplug(); }
  void replug() override { fake_.replug(); }

private:
  static constexpr int frames = 6;

  hal::linux_backend::MonotonicClock clock_;
  FakeCamera fake_;
  std::unique_ptr<hal::LineCamera> camera_ = hal::linux_backend::make_genicam_camera(
      {.address = {hal::linux_backend::GenicamAddress::Bus::gige_vision, FakeCamera::address},
       .trigger = "Software"},
      clock_);
};

const LineCameraCase gige_on_loopback{"gige_on_loopback",
                                      [] { return std::make_unique<LoopbackGenicamBench>(); }};

} // namespace

INSTANTIATE_TEST_SUITE_P(Genicam, LineCameraContract, testing::Values(gige_on_loopback),
                         NameOfCase{});
INSTANTIATE_TEST_SUITE_P(Genicam, LineCameraLoansContract, testing::Values(gige_on_loopback),
                         NameOfCase{});

} // namespace octascope::tests
