#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <random>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/acquisition/b_scan_builder.h"
#include "pipeline/acquisition/repeat_comparison.h"
#include "pipeline/volume/flow_scale.h"
#include "tests/support/allocation_counter.h"

namespace octascope::pipeline {
namespace {

using testing::Each;
using testing::HasSubstr;
using Bins = std::vector<PackedBin>;

constexpr int surface = 40;
constexpr int first_flowing = 20; // A-scans, in B-scans where some flow
constexpr int last_flowing = 27;

ScanPlan repeated_plan() {
  ScanPlan plan;
  plan.samples = 192;
  plan.a_scans = 64;
  plan.b_scans = 2;
  plan.repeats = 3;
  return plan;
}

// Below the surface, speckle of power 1000 and noise of power 2, above it noise; between two A-scans
// the speckle is another in each repeat.
std::vector<Bins> speckle(const ScanPlan& plan, int from, int to) {
  std::mt19937 random{7};
  std::normal_distribution<float> normal;
  const auto draw = [&](float power) {
    return std::sqrt(power / 2) * std::complex<float>{normal(random), normal(random)};
  };
  std::vector<std::complex<float>> still(plan.geometry().b_scan_voxels());
  std::ranges::generate(still, [&] { return draw(1000); });
  std::vector<Bins> repeats;
  for (int m = 0; m < plan.repeats; ++m) {
    Bins bins;
    for (std::size_t i = 0; i < still.size(); ++i) {
      const int a = static_cast<int>(i) / plan.geometry().depths;
      auto bin = a >= from && a <= to ? draw(1000) : still[i];
      if (static_cast<int>(i) % plan.geometry().depths < surface)
        bin = 0;
      bins.push_back(PackedBin::of(bin + draw(2)));
    }
    repeats.push_back(std::move(bins));
  }
  return repeats;
}

class RepeatComparisonTest : public testing::Test {
protected:
  RepeatComparisonTest() {
    for (int repeat = 0; repeat < plan.repeats; ++repeat)
      frames[static_cast<std::size_t>(repeat)].buffer = repeat;
  }

  // Sweeps are what `sweeps` has for the frame's buffer, their levels all 10 more than that number.
  // A-scans are saturated from one on.
  BScanBuilder builder() {
    auto made = RepeatComparison::create(
        plan, 1, [this](std::size_t, const hal::LineFrame& frame, const SweepBins& out) {
          std::ranges::copy(sweeps[static_cast<std::size_t>(frame.buffer)], out.bins.begin());
          std::ranges::fill(out.levels, static_cast<std::uint8_t>(10 + frame.buffer));
          std::ranges::fill(out.saturated.subspan(static_cast<std::size_t>(saturated_from)),
                            std::uint8_t{1});
          return plan.a_scans - saturated_from;
        });
    EXPECT_TRUE(made);
    return {plan, 1, {}, std::move(*made)};
  }
  FlowState tell(BScanBuilder& builder) {
    saturated_lines = builder.build(0, 1, frames, SweepAlignment{plan, 0}, nullptr, levels);
    return builder.tell_flow(0, flow);
  }
  std::span<const std::uint8_t> line(int a) const {
    const auto depths = static_cast<std::size_t>(plan.geometry().depths);
    return std::span{flow}.subspan(static_cast<std::size_t>(a) * depths, depths);
  }
  std::span<const std::uint8_t> tissue(int a) const { return line(a).subspan(surface + 2); }
  double share_flowing(int a) const {
    return static_cast<double>(
               std::ranges::count_if(tissue(a), [](int count) { return count > 127; })) /
           static_cast<double>(tissue(a).size());
  }

  ScanPlan plan = repeated_plan();
  std::vector<Bins> sweeps = speckle(plan, first_flowing, last_flowing);
  std::array<hal::LineFrame, 3> frames;
  int saturated_from = plan.a_scans;
  int saturated_lines = 0;
  std::vector<std::uint8_t> levels =
      std::vector<std::uint8_t>(plan.geometry().b_scan_voxels(), std::uint8_t{99});
  std::vector<std::uint8_t> flow = levels;
};

TEST_F(RepeatComparisonTest, tells_what_changes_between_repeats_and_averages_their_levels) {
  BScanBuilder maker = builder();
  EXPECT_TRUE(maker.compares());
  EXPECT_EQ(tell(maker), FlowState::told);
  EXPECT_THAT(levels, Each(11));
  for (int a = first_flowing + 1; a < last_flowing; ++a)
    EXPECT_GT(share_flowing(a), 0.9) << a;
  for (int a = 0; a < plan.a_scans; ++a)
    if (a < first_flowing - 1 || a > last_flowing + 1) {
      EXPECT_LT(share_flowing(a), 0.05) << a;
      EXPECT_EQ(std::ranges::count(tissue(a), flow_untold), 0) << a;
    }
}

TEST_F(RepeatComparisonTest, of_a_b_scan_that_misses_a_sweep_nothing_is_told) {
  BScanBuilder maker = builder();
  tell(maker);
  frames[1].buffer = -1;
  EXPECT_EQ(tell(maker), FlowState::none);
  EXPECT_THAT(flow, Each(flow_untold));
  EXPECT_THAT(levels, Each(11)) << "of the two that came";
}

TEST_F(RepeatComparisonTest, repeats_with_nothing_in_common_are_left_out) {
  sweeps = speckle(plan, 0, plan.a_scans);
  BScanBuilder maker = builder();
  EXPECT_EQ(tell(maker), FlowState::left_out);
  EXPECT_THAT(flow, Each(flow_untold));
}

// A reflex clips lines: bright, and another in each sweep.
TEST_F(RepeatComparisonTest, nothing_is_told_around_a_saturated_line_and_it_makes_nobody_flow) {
  saturated_from = 40;
  std::mt19937 random{3};
  std::normal_distribution<float> normal{0, 3000};
  for (Bins& sweep : sweeps)
    for (PackedBin& bin : std::span{sweep}.subspan(40 * 96))
      bin = PackedBin::of({normal(random), normal(random)});
  BScanBuilder maker = builder();
  EXPECT_EQ(tell(maker), FlowState::told) << "their motion is nobody's";
  EXPECT_EQ(saturated_lines, plan.repeats * (plan.a_scans - 40));
  for (int a = 36; a < plan.a_scans; ++a)
    EXPECT_THAT(line(a), Each(flow_untold)) << a;
  for (const int a : {5, 10, 34, 35})
    EXPECT_LT(share_flowing(a), 0.05) << a;
  EXPECT_GT(share_flowing(24), 0.9);
  saturated_from = plan.a_scans; // of the next B-scan none is
  sweeps = speckle(plan, first_flowing, last_flowing);
  tell(maker);
  EXPECT_EQ(std::ranges::count(tissue(50), flow_untold), 0);
}

TEST_F(RepeatComparisonTest, allocates_nothing) {
  BScanBuilder maker = builder();
  const auto before = tests::allocations_of_this_thread();
  tell(maker);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
}

TEST_F(RepeatComparisonTest, refuses_plans_without_repeats_in_one_direction_and_says_what_to_do) {
  plan.repeats = 1;
  const auto single = RepeatComparison::create(plan, 1, {});
  ASSERT_FALSE(single);
  EXPECT_THAT(single.error().message, HasSubstr("repeats is 1, expected 2 to 4; --repeats 2"));
  plan.repeats = 2;
  plan.bidirectional = true;
  const auto there_and_back = RepeatComparison::create(plan, 1, {});
  ASSERT_FALSE(there_and_back);
  EXPECT_THAT(there_and_back.error().message, HasSubstr("leave out --bidirectional"));
}

} // namespace
} // namespace octascope::pipeline
