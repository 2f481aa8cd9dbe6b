#include <cmath>

#include <gtest/gtest.h>

#include "sim/spectra/beam_path.h"
#include "sim/spectra/scan_motion.h"

namespace octascope::sim {
namespace {

pipeline::ScanPlan there_and_back() {
  pipeline::ScanPlan plan;
  plan.a_scans = 100;
  plan.turn_around_lines = 8;
  plan.bidirectional = true;
  return plan;
}

TEST(BeamPath, goes_there_and_back_over_the_same_a_scans) {
  const BeamPath path{there_and_back(), 0};
  for (int line = 0; line < 100; ++line) {
    EXPECT_DOUBLE_EQ(path.a_scan_at(0, line), line);
    EXPECT_DOUBLE_EQ(path.a_scan_at(1, line), 99 - line);
    EXPECT_DOUBLE_EQ(path.a_scan_at(6, line), line);
  }
}

TEST(BeamPath, never_jumps_and_turns_smoothly) {
  const BeamPath path{there_and_back(), 3.3};
  double place = path.a_scan_at(0, 0);
  double speed = path.a_scan_at(0, 1) - place;
  for (int i = 1; i < 108 * 6; ++i) {
    const double next = path.a_scan_at(i / 108, i % 108);
    EXPECT_LE(std::abs(next - place), 1.001) << i;
    EXPECT_LE(std::abs(next - place - speed), 2.0 / 9 + 1e-9) << i;
    EXPECT_GE(next, -2.3);
    EXPECT_LE(next, 101.3);
    speed = next - place;
    place = next;
  }
}

TEST(BeamPath, the_mirror_is_where_the_command_was_before) {
  const BeamPath path{there_and_back(), 2.5};
  EXPECT_DOUBLE_EQ(path.a_scan_at(2, 50), 47.5);
  EXPECT_DOUBLE_EQ(path.a_scan_at(3, 50), 51.5);
  pipeline::ScanPlan one_way = there_and_back();
  one_way.bidirectional = false;
  EXPECT_DOUBLE_EQ((BeamPath{one_way, 2.5}.a_scan_at(3, 50)), 50);
}

TEST(BeamPath, repeats_stay_on_their_b_scan) {
  pipeline::ScanPlan plan = there_and_back();
  plan.repeats = 3;
  plan.b_scans = 5;
  plan.b_spacing_um = 100;
  const BeamPath path{plan, 0};
  for (int sweep = 0; sweep < plan.sweeps(); ++sweep)
    EXPECT_NEAR(path.at(sweep, 0).y_mm, (sweep / 3 - 2) * 0.1, 1e-6) << sweep;
  EXPECT_LT(path.at(2, 40).x_mm, path.at(2, 41).x_mm);
  EXPECT_GT(path.at(3, 40).x_mm, path.at(3, 41).x_mm) << "every second sweep, also of one B-scan";
}

TEST(ScanMotion, meets_only_sweeps_that_are_made_alike) {
  const ScanMotion motion{.breathing_b_scans = 3.4, .drift_b_scans = 2};
  for (int alike_every : {1, 2, 3, 6}) {
    for (int t_ms = 0; t_ms < 8000; t_ms += 130) {
      for (int sweep = 0; sweep < 25; ++sweep) {
        const int met =
            motion.met_sweep(sweep, 25, alike_every, 1, std::chrono::milliseconds{t_ms});
        ASSERT_EQ((met - sweep) % alike_every, 0);
        ASSERT_GE(met, 0);
        ASSERT_LT(met, 25);
      }
    }
  }
}

} // namespace
} // namespace octascope::sim
