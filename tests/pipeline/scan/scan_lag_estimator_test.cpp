#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/scan/scan_lag_estimator.h"
#include "pipeline/scan/scan_lag_tracker.h"
#include "tests/support/allocation_counter.h"

namespace octascope::pipeline {
namespace {

ScanPlan plan_of_100() {
  ScanPlan plan;
  plan.samples = 128;
  plan.a_scans = 100;
  plan.b_scans = 40;
  plan.bidirectional = true;
  plan.turn_around_lines = 8;
  return plan;
}

// Level at an A-scan, a depth and a B-scan.
using Scene = std::function<double(double a, int z, int b)>;

// A wavy surface, bright below, that comes back to itself nowhere and is the same in all B-scans;
// `slant` A-scans from one to the next.
Scene tissue(double slant) {
  return [slant](double a, int z, int b) {
    const double x = a - slant * b;
    const double surface = 20 + 6 * std::sin(x * 0.23) + 4 * std::sin(x * 0.071 + 1);
    const double below = 1 / (1 + std::exp((surface - z) / 1.5)); // no sharper than optics are
    return 70 + below * (40 - 0.5 * (z - surface));
  };
}

double flat(double, int z, int) {
  return 100 - z;
}

DownsampledSweep sketch_of(const ScanPlan& plan, const Scene& scene, double lag,
                           double noise_counts, unsigned seed) {
  std::mt19937 random{seed};
  std::normal_distribution<double> noise{0, noise_counts};
  DownsampledSweep sketch{plan};
  const int depths = plan.geometry().depths;
  std::vector<std::uint8_t> levels(static_cast<std::size_t>(depths * plan.lines_per_frame()));
  for (int sweep = 0; sweep < plan.sweeps(); ++sweep) {
    auto level = levels.begin();
    for (int line = 0; line < plan.lines_per_frame(); ++line) {
      const double a = plan.runs_backwards(sweep) ? plan.a_scans - 1 - line + lag : line - lag;
      for (int z = 0; z < depths; ++z, ++level)
        *level = static_cast<std::uint8_t>(
            std::clamp(scene(a, z, plan.b_scan_of(sweep)) + noise(random), 0.0, 255.0));
    }
    sketch.draw(sweep, levels);
  }
  return sketch;
}

TEST(ScanLagEstimator, finds_the_lag_through_noise) {
  const ScanPlan plan = plan_of_100();
  ScanLagEstimator estimator{plan};
  for (const double lag : {-6.0, -0.3, 0.0, 2.71, 5.5, 13.2}) {
    const auto estimate = estimator.estimate(sketch_of(plan, tissue(0), lag, 6, 1));
    EXPECT_TRUE(estimate.convincing()) << lag;
    EXPECT_NEAR(estimate.scan_lag_a_scans, lag, 0.1);
  }
}

TEST(ScanLagEstimator, tissue_that_slants_across_the_scan_does_not_lead_it_astray) {
  const ScanPlan plan = plan_of_100();
  ScanLagEstimator estimator{plan};
  for (const double slant : {-1.7, 0.6, 1.7}) {
    const auto estimate = estimator.estimate(sketch_of(plan, tissue(slant), 4.3, 8, 2));
    EXPECT_TRUE(estimate.convincing()) << slant;
    EXPECT_NEAR(estimate.scan_lag_a_scans, 4.3, 0.06) << slant;
    EXPECT_NEAR(estimate.disagreement_a_scans, 2 * std::abs(slant), 0.3) << slant;
  }
}

TEST(ScanLagEstimator, compares_repeats_of_a_b_scan_with_each_other) {
  for (const int repeats : {2, 3, 4}) {
    ScanPlan plan = plan_of_100();
    plan.repeats = repeats;
    plan.b_scans = 16;
    ScanLagEstimator estimator{plan};
    // Slants so steeply that pairs across B-scans would say something else.
    const auto estimate = estimator.estimate(sketch_of(plan, tissue(6), 3.4, 8, 3));
    EXPECT_TRUE(estimate.convincing()) << repeats;
    EXPECT_NEAR(estimate.scan_lag_a_scans, 3.4, 0.06) << repeats;
  }
}

TEST(ScanLagEstimator, noise_without_features_never_convinces) {
  const ScanPlan plan = plan_of_100();
  ScanLagEstimator estimator{plan};
#ifdef OCTASCOPE_SANITIZED
  constexpr unsigned seeds = 20;
#else
  constexpr unsigned seeds = 200;
#endif
  for (unsigned seed = 0; seed < seeds; ++seed)
    EXPECT_FALSE(estimator.estimate(sketch_of(plan, flat, 0, 12, seed)).convincing()) << seed;
}

TEST(ScanLagEstimator, nothing_at_all_and_lone_sweeps_do_not_convince) {
  const ScanPlan plan = plan_of_100();
  ScanLagEstimator estimator{plan};
  EXPECT_FALSE(estimator.estimate(DownsampledSweep{plan}).convincing());
  EXPECT_FALSE(estimator.estimate(sketch_of(plan, flat, 0, 0, 1)).convincing());
  ScanPlan tiny = plan;
  tiny.a_scans = 1;
  tiny.b_scans = 1;
  ScanLagEstimator of_tiny{tiny};
  EXPECT_FALSE(of_tiny.estimate(sketch_of(tiny, tissue(0), 0, 3, 1)).convincing());
}

TEST(ScanLagEstimator, allocates_nothing) {
  const ScanPlan plan = plan_of_100();
  ScanLagEstimator estimator{plan};
  const DownsampledSweep sketch = sketch_of(plan, tissue(0), 1, 5, 1);
  const auto before = tests::allocations_of_this_thread();
  const auto estimate = estimator.estimate(sketch);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
  EXPECT_GT(estimate.pairs, 0);
}

ScanLagEstimate says(double a_scans) {
  return {.scan_lag_a_scans = a_scans,
          .correlation = 0.5,
          .significance = 20,
          .rival = 0.3,
          .disagreement_a_scans = 0,
          .pairs = 20};
}

TEST(ScanLagTracker, needs_two_that_agree_for_a_jump) {
  ScanLagTracker tracker{0};
  EXPECT_FALSE(tracker.update(says(5.4)));
  EXPECT_EQ(tracker.in_use_a_scans(), 0);
  EXPECT_FALSE(tracker.update(says(-3)));
  EXPECT_FALSE(tracker.update(says(5.4))) << "the last one said something else";
  EXPECT_TRUE(tracker.update(says(5.2)));
  EXPECT_DOUBLE_EQ(tracker.in_use_a_scans(), 5.3);
  EXPECT_FALSE(tracker.update(says(17)));
  EXPECT_TRUE(tracker.update(says(5.3)));
  EXPECT_DOUBLE_EQ(tracker.in_use_a_scans(), 5.3);
  EXPECT_FALSE(tracker.update(says(17))) << "the stray ones were not in a row";
  EXPECT_EQ(tracker.used(), 2U);
  EXPECT_EQ(tracker.refused(), 5U);
}

TEST(ScanLagTracker, follows_a_drift_and_averages_noise) {
  ScanLagTracker tracker{2};
  for (int i = 1; i <= 100; ++i)
    EXPECT_TRUE(tracker.update(says(2 + 0.05 * i)));
  EXPECT_NEAR(tracker.in_use_a_scans(), 7, 0.06);
  tracker.update(says(7.2));
  EXPECT_NEAR(tracker.in_use_a_scans(), 7.1, 0.06);
}

TEST(ScanLagTracker, what_does_not_convince_changes_nothing) {
  ScanLagTracker tracker{1.5};
  ScanLagEstimate estimate = says(4);
  for (int i = 0; i < 10; ++i) {
    estimate = says(4);
    estimate.significance = 3;
    EXPECT_FALSE(tracker.update(estimate));
    estimate = says(1.6);
    estimate.rival = 0.95;
    EXPECT_FALSE(tracker.update(estimate));
    estimate = says(1.6);
    estimate.disagreement_a_scans = 9;
    EXPECT_FALSE(tracker.update(estimate));
  }
  EXPECT_EQ(tracker.in_use_a_scans(), 1.5);
  EXPECT_FALSE(tracker.found());
}

} // namespace
} // namespace octascope::pipeline
