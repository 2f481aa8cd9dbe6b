#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "firmware-host/report/notice.h"
#include "pipeline/acquisition/volume_thread.h"
#include "sim/clock/virtual_clock.h"
#include "tests/support/devices/fake_devices.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using hal::DeviceState;

constexpr hal::TimePoint now{100s};

// By its keys in reports.
pipeline::FaultRecord fault(std::string_view device, std::string_view kind, hal::Duration ago) {
  for (std::size_t i = 0; i < pipeline::fault_count; ++i) {
    const auto facts = facts_of(static_cast<pipeline::Fault>(i));
    if (facts.device_key() == device && facts.key == kind)
      return {facts.fault, "", 1, now - ago, now - ago};
  }
  throw std::logic_error{fmt::format("there is no fault {} {}", device, kind)};
}

class Notice : public testing::Test {
protected:
  std::string_view of(std::vector<pipeline::FaultRecord> faults) const {
    return compose_notice(faults, devices, now);
  }

  std::array<ui::DeviceStatus, 4> devices{
      {{pipeline::Device::line_camera, "sim", DeviceState::streaming},
       {pipeline::Device::galvo_trigger, "sim", DeviceState::ready},
       {pipeline::Device::control_input, "sim", DeviceState::ready},
       {pipeline::Device::scope_camera, "sim", DeviceState::streaming}}};
};

TEST_F(Notice, is_empty_when_nothing_is_wrong) {
  EXPECT_EQ(of({}), "");
}

TEST_F(Notice, is_empty_while_devices_are_opened_for_the_first_time) {
  devices[0].state = DeviceState::absent;
  EXPECT_EQ(of({}), "");
}

TEST_F(Notice, names_a_device_for_as_long_as_it_is_away) {
  const auto lost = fault("line_camera", "disconnected", 1h);
  EXPECT_EQ(of({lost}), "") << "back";
  for (const DeviceState state : {DeviceState::absent, DeviceState::failed}) {
    devices[0].state = state;
    EXPECT_EQ(of({lost}), "Line camera disconnected: reconnecting");
  }
}

TEST_F(Notice, of_a_device_that_may_not_be_opened_does_not_call_it_disconnected) {
  devices[0].state = DeviceState::absent;
  const auto denied = fault("line_camera", "denied", 1s);
  EXPECT_EQ(of({fault("line_camera", "disconnected", 2s), denied}),
            "Line camera may not be opened: ask octascope doctor");
  EXPECT_EQ(of({denied, fault("line_camera", "disconnected", 0s)}),
            "Line camera disconnected: reconnecting");
  EXPECT_EQ(of({denied, fault("scope_camera", "disconnected", 0s)}),
            "Line camera may not be opened: ask octascope doctor");
}

TEST_F(Notice, names_any_other_fault_until_two_seconds_after_it) {
  EXPECT_NE(of({fault("line_camera", "dropped_frames", 0s)}), "");
  EXPECT_NE(of({fault("line_camera", "dropped_frames", 2s)}), "");
  EXPECT_EQ(of({fault("line_camera", "dropped_frames", 2001ms)}), "");
}

TEST_F(Notice, tells_of_a_restart_after_a_crash_for_a_minute) {
  EXPECT_NE(of({fault("host", "restarted_after_crash", 60s)}), "");
  EXPECT_EQ(of({fault("host", "restarted_after_crash", 61s)}), "");
  const auto drops = fault("line_camera", "dropped_frames", 0s);
  EXPECT_EQ(of({fault("host", "restarted_after_crash", 0s), drops}), of({drops}))
      << "and not in the place of what goes wrong now";
}

TEST_F(Notice, names_threads_that_hang) {
  for (const char* device : {"line_camera", "pipeline", "control_input", "scope_camera"})
    EXPECT_NE(of({fault(device, "stuck_thread", 0s)}), "") << device;
}

TEST_F(Notice, names_what_befalls_the_machine) {
  for (const char* kind : {"throttled", "low_memory", "disk_full"})
    EXPECT_NE(of({fault("host", kind, 0s)}), "") << kind;
}

TEST_F(Notice, of_several_names_the_gravest) {
  const auto light = fault("line_camera", "saturation", 0s);
  const auto drops = fault("line_camera", "dropped_frames", 1s);
  const auto pedal = fault("control_input", "disconnected", 1h);
  EXPECT_EQ(of({light, drops, pedal}), of({drops}));
  EXPECT_EQ(of({drops, light}), of({drops})) << "in any order";
  devices[2].state = DeviceState::absent;
  EXPECT_EQ(of({light, drops, pedal}), "Pedal disconnected: reconnecting");
}

TEST_F(Notice, leaves_to_the_report_what_a_surgeon_cannot_use) {
  EXPECT_EQ(of({fault("host", "no_realtime", 0s), fault("line_camera", "stuck_sequence", 0s),
                fault("control_input", "bounce", 0s)}),
            "");
}

TEST_F(Notice, a_picture_that_could_not_be_kept_is_told) {
  EXPECT_NE(of({fault("host", "picture_not_kept", 0s)}), "");
}

TEST_F(Notice, a_recording_that_ended_by_itself_is_told) {
  for (const char* kind : {"disk_full", "gone", "not_kept", "not_finished", "not_begun"})
    EXPECT_NE(of({fault("recording", kind, 0s)}), "") << kind;
}

// The pipeline loses volumes and B-scans in each way that no script of faults brings about
// (tests/program/appliance/fault_test.cpp has those): what it tells of that is in the notice.
class LosingPipeline : public testing::Test {
protected:
  static constexpr int b_scans = 8;

  LosingPipeline() {
    hal::LineCameraConfig config;
    config.format.samples_per_line = plan_.samples;
    config.format.lines_per_frame = plan_.lines_per_frame();
    config.buffers = 64;
    acquisition_ =
        std::make_unique<pipeline::Acquisition>(camera_, config, clock_, faults_, arrived_);
    volumes_ = std::make_unique<pipeline::VolumeThread>(
        pipeline::VolumeThreadSetup{
            .plan = plan_,
            .trigger = {},
            .workers = 1,
            .reconstruct =
                [this](std::size_t, const hal::LineFrame&, std::span<std::uint8_t>) {
                  if (workers_hang_)
                    go_on_.wait();
                  return 0;
                },
            .average = *pipeline::NeighbourAverage::create({0, 1, 0}),
            .most_volumes = std::nullopt},
        trigger_, *acquisition_, camera_, clock_, faults_, arrived_, news_);
    EXPECT_TRUE(acquisition_->start({}));
    await([this] { return camera_.state() == DeviceState::streaming; });
    volumes_->start({});
    armed_ = trigger_.wait_for_pulse(0);
  }
  ~LosingPipeline() override {
    workers_hang_ = false;
    for (int i = 0; i < 100; ++i)
      go_on_.post();
    volumes_->stop();
    acquisition_->stop();
  }

  static pipeline::ScanPlan small_plan() {
    pipeline::ScanPlan plan;
    plan.samples = 32;
    plan.a_scans = 4;
    plan.fly_back_lines = 1;
    plan.b_scans = b_scans;
    plan.line_rate_hz = 5000;
    return plan;
  }
  static void await(const std::function<bool()>& so) {
    while (!so())
      std::this_thread::sleep_for(100us);
  }
  void deliver(int sweep) {
    camera_.deliver(sequence_++, armed_ + sweep * plan_.frame_period(), 10);
  }

  // The notice about what the pipeline tells of, which is this alone.
  std::string_view notice_of(pipeline::Fault kind) {
    await([&] {
      const auto records = faults_.records();
      return std::ranges::find(records, kind, &pipeline::FaultRecord::kind) != records.end();
    });
    const auto records = faults_.records();
    const auto told = std::ranges::find(records, kind, &pipeline::FaultRecord::kind);
    return compose_notice({&*told, 1}, {}, told->last);
  }

  const pipeline::ScanPlan plan_ = small_plan();
  sim::VirtualClock clock_;
  tests::FakeCamera camera_;
  tests::FakeTrigger trigger_{clock_};
  pipeline::FaultLog faults_;
  pipeline::Wakeup arrived_, news_;
  hal::Semaphore go_on_;
  std::atomic<bool> workers_hang_{false};
  std::unique_ptr<pipeline::Acquisition> acquisition_;
  std::unique_ptr<pipeline::VolumeThread> volumes_;
  hal::TimePoint armed_;
  std::uint64_t sequence_ = 0;
};

TEST_F(LosingPipeline, tells_of_ticks_that_it_slept_through) {
  clock_.advance(4 * plan_.tick_period());
  EXPECT_EQ(notice_of(pipeline::Fault::late_tick), "The computer is busy: volumes are lost");
}

TEST_F(LosingPipeline, tells_of_workers_that_are_too_slow) {
  workers_hang_ = true;
  for (int n = 1; n <= 3; ++n) {
    deliver(0);
    await([&] { return acquisition_->counters().frames == sequence_; });
    clock_.sleep_until(armed_ + plan_.tick_period());
    armed_ = trigger_.wait_for_pulse(static_cast<std::size_t>(n));
  }
  EXPECT_EQ(notice_of(pipeline::Fault::overrun), "Reconstruction is too slow: volumes are lost");
}

TEST_F(LosingPipeline, tells_of_frames_that_were_exposed_outside_every_sweep) {
  deliver(b_scans + 1);
  EXPECT_EQ(notice_of(pipeline::Fault::unplaced_frame),
            "Line camera is out of step: B-scans are missing");
}

TEST_F(LosingPipeline, tells_of_sweeps_that_come_twice) {
  deliver(0);
  deliver(0);
  EXPECT_EQ(notice_of(pipeline::Fault::doubled_frame), "Line camera sends B-scans twice");
}

} // namespace
} // namespace octascope::firmware_host
