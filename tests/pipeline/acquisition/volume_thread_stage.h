// The fixed-rate thread with fake devices, in the time of a test's clock.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "pipeline/acquisition/volume_thread.h"
#include "sim/clock/virtual_clock.h"
#include "tests/support/devices/fake_devices.h"

namespace octascope::pipeline {

using namespace std::chrono_literals;
using hal::DeviceState;
using hal::FrameIntegrity;

// Eight B-scans in 400 ms, which pass when the test says so.
inline ScanPlan slow_plan() {
  ScanPlan plan;
  plan.samples = 32;
  plan.a_scans = 4;
  plan.fly_back_lines = 1;
  plan.b_scans = 8;
  plan.line_rate_hz = 100;
  return plan;
}

inline constexpr std::uint8_t saturated_fill = 200;

class VolumeThreadTest : public testing::Test {
protected:
  // `bins`: of a sweep, where volumes shall have flow.
  explicit VolumeThreadTest(const ScanPlan& scan_plan = slow_plan(),
                            const ReconstructBins& bins = {})
      : plan(scan_plan) {
    hal::LineCameraConfig config;
    config.format.samples_per_line = plan.samples;
    config.format.lines_per_frame = plan.lines_per_frame();
    config.buffers = 24;
    acquisition = std::make_unique<Acquisition>(camera, config, clock, faults, arrived);
    VolumeThreadSetup setup{
        .plan = plan,
        .trigger = {},
        .workers = 2,
        // A level is the frame's fill, so the test sees which frame went where.
        .reconstruct =
            [](std::size_t, const hal::LineFrame& frame, std::span<std::uint8_t> levels) {
              std::ranges::fill(levels, std::to_integer<std::uint8_t>(frame.bytes.front()));
              return frame.bytes.front() == std::byte{saturated_fill} ? 3 : 0;
            },
        .average = *NeighbourAverage::create({0, 1, 0}),
        .wants_every_volume = [this] { return wants_every_volume.load(); },
        .most_volumes = std::nullopt,
    };
    if (bins)
      setup.comparison = *RepeatComparison::create(plan, setup.workers, bins);
    volumes = std::make_unique<VolumeThread>(std::move(setup), trigger, *acquisition, camera, clock,
                                             faults, arrived, news);
  }

  void start() {
    ASSERT_TRUE(acquisition->start({}));
    await([&] { return camera.state() == DeviceState::streaming; });
    volumes->start({});
  }
  void stop() {
    volumes->stop();
    acquisition->stop();
    EXPECT_EQ(camera.on_loan(), 0U);
    const VolumeCounters c = volumes->counters();
    EXPECT_EQ(c.planned, c.acquired + c.passed_over + c.lost_volumes + c.unfinished);
    EXPECT_EQ(c.acquired, c.published);
  }

  // The other threads come to it in their time, which is no time of the test's clock.
  static void await(const std::function<bool()>& so) {
    while (!so())
      std::this_thread::sleep_for(100us);
  }
  void await_frames(std::uint64_t frames) {
    await([&] { return acquisition->counters().frames >= frames; });
  }

  hal::TimePoint time_of(hal::TimePoint pulsed, int sweep) const {
    return pulsed + sweep * plan.frame_period();
  }
  // Until when a volume takes frames; how long after that it waits for a camera not looked at.
  hal::TimePoint accepts_until(hal::TimePoint pulsed) const {
    return pulsed + plan.sweep_duration() + plan.sweep_duration() / 6;
  }
  hal::Duration patience() const { return plan.sweep_duration() / 2; }

  // The B-scans from `begin` to before `end`, in order and each in its time.
  void deliver(hal::TimePoint pulsed, int begin, int end) {
    for (int b = begin; b < end; ++b)
      camera.deliver(static_cast<std::uint64_t>(b), time_of(pulsed, b), 10);
  }

  // So many frames came, and then nobody looks at the camera any more.
  void hold_camera_after(std::uint64_t frames) {
    await_frames(frames);
    camera.hold();
    camera.wait_until_held();
  }

  // Waits until a volume with this number has been published.
  const Volume* wait_for_volume(std::uint64_t number) {
    while (true) {
      if (const Volume* volume = volumes->take_newest(); volume && volume->metadata.index >= number)
        return volume;
      news.wait();
    }
  }

  bool has_fault(Fault kind) const {
    return std::ranges::any_of(faults.records(),
                               [&](const FaultRecord& f) { return f.kind == kind; });
  }

  ScanPlan plan;
  sim::VirtualClock clock;
  tests::FakeCamera camera;
  tests::FakeTrigger trigger{clock};
  FaultLog faults;
  Wakeup arrived, news;
  std::atomic<bool> wants_every_volume{false};
  std::unique_ptr<Acquisition> acquisition;
  std::unique_ptr<VolumeThread> volumes;
};

} // namespace octascope::pipeline
