#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "sim/faults/fault_probe.h"
#include "sim/faults/fault_schedule.h"
#include "tests/sim/twin_support.h"

namespace octascope::sim {
namespace {

using hal::TimePoint;
using pipeline::Fault;
using namespace std::chrono_literals;

constexpr auto camera = pipeline::Device::line_camera;
constexpr auto lost = gone(pipeline::Device::display);
constexpr TimePoint zero{100s};

constexpr std::string_view lost_twice = "[[fault]]\ndevice = \"display\"\nkind = \"lost\"\n"
                                        "at_s = 1\nduration_s = 2\nrepeat_s = 10\n";

TEST(FaultSchedule, nothing_is_active_before_the_start) {
  const FaultSchedule schedule{script_of(lost_twice)};
  EXPECT_FALSE(schedule.active(lost, zero + 2s));
  EXPECT_FALSE(schedule.next_edge(lost, zero));
}

TEST(FaultSchedule, windows_are_half_open_and_repeat) {
  FaultSchedule schedule{script_of(lost_twice)};
  schedule.start(zero);
  const auto active = [&](hal::Duration t) { return schedule.active(lost, zero + t); };
  EXPECT_FALSE(active(-5s));
  EXPECT_FALSE(active(1s - 1ns));
  for (const auto round : {0s, 10s, 1'000'000s}) {
    EXPECT_TRUE(active(round + 1s));
    EXPECT_TRUE(active(round + 3s - 1ns));
    EXPECT_FALSE(active(round + 3s));
    EXPECT_FALSE(active(round + 11s - 1ns));
  }
  EXPECT_FALSE(schedule.active(gone(camera), zero + 2s)) << "another device";
}

TEST(FaultSchedule, edges_are_found_in_order_across_faults) {
  FaultSchedule schedule{script_of(std::string{lost_twice} +
                                   "[[fault]]\ndevice = \"line_camera\"\nkind = \"unplug\"\n"
                                   "at_s = 2\nduration_s = 10\n")};
  schedule.start(zero);
  std::array<FaultEdge, 16> edges;
  ASSERT_EQ(schedule.edges_within(zero, zero + 13s, edges), 6U);
  const std::array<std::pair<hal::Duration, bool>, 6> expected{
      {{1s, true}, {2s, true}, {3s, false}, {11s, true}, {12s, false}, {13s, false}}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(edges[i].time, zero + expected[i].first) << i;
    EXPECT_EQ(edges[i].begins, expected[i].second) << i;
  }
  EXPECT_EQ(edges[1].fault->kind, gone(camera));

  std::array<FaultEdge, 2> few;
  ASSERT_EQ(schedule.edges_within(zero + 1s, zero + 13s, few), 2U);
  EXPECT_EQ(few[0].time, zero + 2s);
  EXPECT_EQ(few[1].time, zero + 3s);
  EXPECT_EQ(schedule.edges_within(zero + 1s, zero + 13s, {}), 0U);
  EXPECT_EQ(schedule.next_edge(lost, zero + 3s), zero + 11s);
}

TEST(FaultSchedule, a_fault_that_came_and_went_is_noticed) {
  FaultSchedule schedule{script_of(lost_twice)};
  schedule.start(zero);
  EXPECT_TRUE(schedule.began_within(lost, zero, zero + 5s));
  EXPECT_FALSE(schedule.began_within(lost, zero + 2s, zero + 5s));
  EXPECT_TRUE(schedule.began_within(lost, zero + 2s, zero + 15s));
}

// How many of `frames` frames, one a millisecond, a probe strikes, and the first that it strikes.
struct Strikes {
  int count = 0;
  int first = -1;
};
Strikes strikes_of(const std::string& parameters, int frames) {
  FaultSchedule schedule{script_of("[[fault]]\ndevice = \"line_camera\"\n"
                                   "kind = \"dropped_frames\"\nat_s = 0\n" +
                                   parameters)};
  schedule.start(zero);
  FaultProbe probe{&schedule, camera};
  Strikes strikes;
  for (int f = 0; f < frames; ++f) {
    EXPECT_EQ(probe.strike(Fault::late_frame, zero), nullptr) << "another kind";
    if (probe.strike(Fault::dropped_frames, zero + f * 1ms) == nullptr)
      continue;
    strikes.first = strikes.first < 0 ? f : strikes.first;
    ++strikes.count;
  }
  return strikes;
}

TEST(FaultProbe, counts_selects_and_repeats) {
  EXPECT_EQ(strikes_of("count = 7", 1000).count, 7);
  EXPECT_EQ(strikes_of("count = 7\nrepeat_s = 0.1", 1000).count, 70);
  EXPECT_EQ(strikes_of("duration_s = 0.05", 1000).count, 50);
  EXPECT_EQ(strikes_of("duration_s = 0.05\ncount = 60", 1000).count, 50);
  EXPECT_EQ(strikes_of("duration_s = 10\nevery = 4", 1000).count, 250);
  EXPECT_EQ(strikes_of("duration_s = 10\nevery = 4", 1000).first, 3);
  EXPECT_EQ(strikes_of("duration_s = 10\nprobability = 0", 1000).count, 0);
}

TEST(FaultProbe, chance_is_fair_and_repeats_with_its_seed) {
  const auto hits = [](int seed) {
    return strikes_of("duration_s = 100\nprobability = 0.1\nseed = " + std::to_string(seed), 20000);
  };
  for (int seed = 1; seed <= 5; ++seed) {
    // 2000 expected, standard deviation 42.4; seeds are fixed, so this either holds or never does.
    EXPECT_NEAR(hits(seed).count, 2000, 5 * 42.4) << seed;
    EXPECT_EQ(hits(seed).count, hits(seed).count);
  }
  EXPECT_NE(hits(1).count, hits(2).count);
}

TEST(FaultProbe, without_a_schedule_nothing_breaks) {
  FaultProbe probe{nullptr, camera};
  EXPECT_FALSE(probe.unplugged(zero));
  EXPECT_FALSE(probe.pulled_since_last_look(zero));
  EXPECT_EQ(probe.strike(Fault::dropped_frames, zero), nullptr);
  EXPECT_FALSE(probe.next_edge(gone(camera), zero));
  EXPECT_FALSE(probe.expects(Fault::dropped_frames));
}

} // namespace
} // namespace octascope::sim
