// The twins under the contracts of their devices, in virtual time and in real time.
#include "sim/devices/sim_control_input.h"
#include "sim/devices/sim_galvo_trigger.h"
#include "sim/devices/sim_line_camera.h"
#include "tests/contract/clock_contract.h"
#include "tests/contract/control_input_contract.h"
#include "tests/contract/galvo_trigger_contract.h"
#include "tests/contract/line_camera_loans_contract.h"
#include "tests/sim/twin_support.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::MonotonicClock;
using sim::VirtualClock;

template <class ClockType> class SimLineCameraBench final : public LineCameraBench {
public:
  SimLineCameraBench() { EXPECT_TRUE(trigger_.open({})); }

  hal::LineCamera& camera() override { return camera_; }
  hal::Clock& clock() override { return clock_; }
  bool time_is_exact() const override { return sim::is_virtual(&clock_); }
  hal::LineCameraConfig config() const override {
    return {.format = source_->format(), .line_rate_hz = 4e3, .buffers = 4};
  }
  void trigger() override { EXPECT_TRUE(trigger_.pulse()); }
  int frames_per_sweep() const override { return source_->sweeps(); }
  hal::Duration sweep_duration() const override { return link_.sweep_duration(); }
  bool can_unplug() const override { return true; }
  void unplug() override { faults_.unplug(clock_.now()); }
  void replug() override { faults_.replug(clock_.now()); }

private:
  ClockType clock_;
  std::unique_ptr<sim::RecordedSpectra> source_ = sim::numbered_spectra(6, 8, 32);
  sim::GalvoLink link_{std::chrono::milliseconds{12}};
  sim::SwitchableFaults faults_{"line_camera"};
  sim::SimGalvoTrigger trigger_{link_, clock_};
  sim::SimLineCamera camera_{*source_, link_, clock_, &faults_.schedule()};
};

template <class ClockType> class SimGalvoTriggerBench final : public GalvoTriggerBench {
public:
  hal::GalvoTrigger& trigger() override { return trigger_; }
  hal::Clock& clock() override { return clock_; }
  std::uint64_t pulses_seen() const override { return link_.sweeps() + link_.lost_pulses(); }
  bool can_unplug() const override { return true; }
  void unplug() override { faults_.unplug(clock_.now()); }
  void replug() override { faults_.replug(clock_.now()); }

private:
  ClockType clock_;
  sim::GalvoLink link_{std::chrono::milliseconds{12}};
  sim::SwitchableFaults faults_{"galvo_trigger"};
  sim::SimGalvoTrigger trigger_{link_, clock_, &faults_.schedule()};
};

template <class ClockType> class SimControlInputBench final : public ControlInputBench {
public:
  hal::ControlInput& input() override { return input_; }
  hal::Clock& clock() override { return clock_; }
  bool time_is_exact() const override { return sim::is_virtual(&clock_); }
  int switches() const override { return sim::switch_count; }
  void set_switch(int index, bool pressed) override {
    inject(hal::ControlKind::pedal_switch, index, pressed);
  }
  bool can_bounce() const override { return true; }
  void make_bouncing() override { faults_.begin_later_fault(clock_.now()); }
  void turn_knob(int detents) override { inject(hal::ControlKind::knob, 0, detents); }
  bool has_axes() const override { return true; }
  void push_axis(int index, int value) override { inject(hal::ControlKind::axis, index, value); }
  bool can_unplug() const override { return true; }
  void unplug() override { faults_.unplug(clock_.now()); }
  void replug() override { faults_.replug(clock_.now()); }

private:
  void inject(hal::ControlKind kind, int index, int value) {
    EXPECT_TRUE(input_.inject({clock_.now(), kind, static_cast<std::uint8_t>(index), value}));
  }

  ClockType clock_;
  sim::SwitchableFaults faults_{"control_input", "bounce"};
  sim::SimControlInput input_{clock_, {}, &faults_.schedule()};
};

template <class Case, template <class> class Bench> auto both_clocks() {
  return testing::Values(
      Case{"virtual_time", [] { return std::make_unique<Bench<VirtualClock>>(); }},
      Case{"real_time", [] { return std::make_unique<Bench<MonotonicClock>>(); }});
}

INSTANTIATE_TEST_SUITE_P(sim, LineCameraContract,
                         (both_clocks<LineCameraCase, SimLineCameraBench>()), NameOfCase{});
INSTANTIATE_TEST_SUITE_P(sim, LineCameraLoansContract,
                         (both_clocks<LineCameraCase, SimLineCameraBench>()), NameOfCase{});
INSTANTIATE_TEST_SUITE_P(sim, GalvoTriggerContract,
                         (both_clocks<GalvoTriggerCase, SimGalvoTriggerBench>()), NameOfCase{});
INSTANTIATE_TEST_SUITE_P(sim, ControlInputContract,
                         (both_clocks<ControlInputCase, SimControlInputBench>()), NameOfCase{});
INSTANTIATE_TEST_SUITE_P(sim, ClockContract,
                         testing::Values(ClockCase{
                             "virtual_time", [] { return std::make_unique<VirtualClock>(); }}),
                         NameOfCase{});

} // namespace
} // namespace octascope::tests
