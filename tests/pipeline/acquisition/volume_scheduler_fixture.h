// What the tests of the fixed-rate thread's decisions share.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/volume_scheduler.h"

namespace octascope::pipeline {

using namespace std::chrono_literals;
using Action = VolumeDecision::Action;

inline constexpr hal::TimePoint first_tick{10s};
inline constexpr hal::Duration moment{1}; // the least that can be told apart

// Eight sweeps of a millisecond.
inline ScanPlan short_plan() {
  ScanPlan plan;
  plan.samples = 32;
  plan.a_scans = 4;
  plan.fly_back_lines = 1;
  plan.b_scans = 8;
  plan.line_rate_hz = 5000;
  return plan;
}

// A scheduler, and frames and volumes in as few words as its tests need.
class VolumeSchedulerTest : public testing::Test {
protected:
  explicit VolumeSchedulerTest(const ScanPlan& scan_plan = short_plan(),
                               std::optional<std::uint64_t> most_volumes = std::nullopt)
      : plan(scan_plan), scheduler(scan_plan, most_volumes) {
    scheduler.begin(first_tick);
  }

  // A tick at that time, whose pulse is made at once.
  std::optional<std::uint32_t> pulse(hal::TimePoint when) {
    EXPECT_TRUE(scheduler.tick_due(when));
    const TickDecision decision = scheduler.tick(when);
    EXPECT_EQ(decision.slept_through, 0U);
    EXPECT_TRUE(decision.pulse);
    return scheduler.pulsed(when);
  }
  hal::TimePoint tick(int n) const { return first_tick + n * plan.tick_period(); }
  hal::TimePoint time_of(hal::TimePoint pulsed, int sweep) const {
    return pulsed + sweep * plan.frame_period();
  }
  // Until when a volume takes frames, if the camera was looked at; and if it was not.
  hal::TimePoint accepts_until(hal::TimePoint pulsed) const {
    return pulsed + plan.sweep_duration() + plan.sweep_duration() / 6;
  }
  hal::Duration patience() const { return plan.sweep_duration() / 2; }

  FrameDecision frame(hal::TimePoint pulsed, int sweep) {
    const hal::TimePoint first_line = time_of(pulsed, sweep);
    return scheduler.place(first_line, first_line + 4 * plan.line_period());
  }
  // The workers are quick.
  void make(std::span<const BScanJob> jobs) {
    for (const BScanJob& job : jobs)
      scheduler.b_scan_made(job.buffer);
  }
  void deliver(hal::TimePoint pulsed, int begin, int end) {
    for (int sweep = begin; sweep < end; ++sweep) {
      const FrameDecision decision = frame(pulsed, sweep);
      EXPECT_EQ(decision.verdict, FrameVerdict::placed) << sweep;
      make(decision.submit);
    }
  }
  // The camera was looked at, and streams.
  VolumeDecision next(hal::TimePoint now) { return scheduler.next(now, now, true); }
  VolumeDecision next_unlooked(hal::TimePoint now) {
    return scheduler.next(now, hal::TimePoint{}, true);
  }
  std::vector<BScanJob> jobs(std::span<const BScanJob> decided) const {
    return {decided.begin(), decided.end()};
  }

  ScanPlan plan;
  VolumeScheduler scheduler;
};

} // namespace octascope::pipeline
