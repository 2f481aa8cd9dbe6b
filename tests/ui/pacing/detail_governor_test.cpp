#include <random>

#include <gtest/gtest.h>

#include "ui/vessels/hybrid/detail_governor.h"

namespace octascope::tests {
namespace {

// Costs of a tree: a fixed part, and one that falls as more is merged.
double cost_ms(float detail_px, double full_ms) {
  constexpr double thin_px = 0.05;
  return 6 + full_ms * std::min(1.0, thin_px / std::max(double{detail_px}, 1e-6));
}

TEST(DetailGovernor, draws_everything_where_there_is_time) {
  ui::DetailGovernor governor{hal::from_seconds(0.04)};
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(governor.detail_px(false), 0);
    governor.note(hal::from_seconds(1e-3 * cost_ms(0, 20)));
  }
}

TEST(DetailGovernor, comes_into_the_budget_and_stays_without_swinging) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> noise{0.96, 1.04};
  ui::DetailGovernor governor{hal::from_seconds(0.04)};
  const auto frame = [&](double full_ms) {
    const float detail = governor.detail_px(false);
    const bool interrupted = random() % 16 == 0;
    const double ms = cost_ms(detail, full_ms) * noise(random);
    governor.note(hal::from_seconds(1e-3 * (interrupted ? 3 * ms : ms)));
    return detail;
  };
  for (int i = 0; i < 90; ++i)
    frame(120);
  EXPECT_LT(cost_ms(governor.detail_px(false), 120), 41);
  EXPECT_GT(cost_ms(governor.detail_px(false), 120), 20); // no more is merged than must be
  for (int i = 0; i < 200; ++i) {
    const float before = governor.detail_px(false);
    frame(25); // zoomed in: there is time again
    EXPECT_LE(governor.detail_px(false), before);
  }
  EXPECT_EQ(governor.detail_px(false), 0);
}

// As measured: merging but few costs more than it spares.
double humped_cost_ms(float detail_px, double full_ms) {
  return cost_ms(detail_px, full_ms) *
         (detail_px > 0 ? 1.7 - 0.5 * std::min(double{detail_px} / 0.2, 1.0) : 1);
}

TEST(DetailGovernor, settles_though_merging_has_its_price) {
  std::mt19937_64 random{2};
  std::uniform_real_distribution<double> noise{0.98, 1.02};
  for (const double full_ms : {20.0, 30.0, 36.0, 40.0, 60.0, 120.0, 300.0}) {
    ui::DetailGovernor governor{hal::from_seconds(0.04)};
    const auto frame = [&](double ms) {
      const double cost = humped_cost_ms(governor.detail_px(false), ms) * noise(random);
      governor.note(hal::from_seconds(1e-3 * cost));
      return cost;
    };
    for (const double scene_ms : {full_ms, 150.0, full_ms}) {
      for (int i = 0; i < 400; ++i)
        frame(scene_ms);
      int turns = 0;
      bool rising = false;
      float before = governor.detail_px(false);
      for (int i = 0; i < 400; ++i) {
        EXPECT_LT(frame(scene_ms), 42) << scene_ms;
        const float now = governor.detail_px(false);
        if (now > before || now < before) {
          turns += rising != (now > before);
          rising = now > before;
        }
        before = now;
      }
      EXPECT_LE(turns, 2) << scene_ms;
    }
  }
}

// Shading goes before anything is merged, comes back after, and does neither in turns.
TEST(DetailGovernor, drops_the_shading_first) {
  std::mt19937_64 random{3};
  std::uniform_real_distribution<double> noise{0.98, 1.02};
  constexpr double shading_ms = 4;
  for (const double full_ms : {20.0, 30.0, 33.0, 60.0}) {
    ui::DetailGovernor governor{hal::from_seconds(0.04)};
    int turns = 0;
    bool before = true;
    bool merged = false;
    for (int i = 0; i < 600; ++i) {
      const bool occluded = governor.occluded(false);
      merged = merged || governor.detail_px(false) > 0;
      EXPECT_FALSE(occluded && governor.detail_px(false) > 0) << full_ms;
      EXPECT_FALSE(merged && full_ms < 34) << full_ms;
      turns += occluded != before;
      before = occluded;
      const double ms = cost_ms(governor.detail_px(false), full_ms) + (occluded ? shading_ms : 0);
      governor.note(hal::from_seconds(1e-3 * ms * noise(random)));
    }
    EXPECT_EQ(before, full_ms < 29) << full_ms;
    EXPECT_LE(turns, 1) << full_ms;
    for (int i = 0; i < 300; ++i) // there is time again
      governor.note(hal::from_seconds(1e-3 * cost_ms(governor.detail_px(false), 15)));
    EXPECT_TRUE(governor.occluded(false)) << full_ms;
    EXPECT_TRUE(governor.occluded(true));
  }
}

TEST(DetailGovernor, at_rest_everything_is_drawn) {
  ui::DetailGovernor governor{hal::from_seconds(0.01)};
  for (int i = 0; i < 60; ++i)
    governor.note(hal::from_seconds(0.1));
  EXPECT_GT(governor.detail_px(false), 0);
  EXPECT_EQ(governor.detail_px(true), 0);
}

} // namespace
} // namespace octascope::tests
