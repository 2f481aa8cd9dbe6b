// Transfer functions against closed forms.
#include <algorithm>
#include <array>
#include <memory>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/volume/level_scale.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "ui/transfer/transfer_set.h"

namespace octascope::tests {
namespace {

using ui::CurvePoint;
using ui::TransferCurve;
using ui::TransferTable;

TEST(TransferCurve, piecewise_is_linear_between_its_points_and_level_outside) {
  const std::array<CurvePoint, 3> points{{{0.2F, 0.1F}, {0.4F, 0.9F}, {0.8F, 0.5F}}};
  const auto curve = TransferCurve::piecewise(points);
  ASSERT_TRUE(curve) << curve.error().message;
  EXPECT_FLOAT_EQ(curve->opacity(0), 0.1F);
  EXPECT_FLOAT_EQ(curve->opacity(0.2F), 0.1F);
  EXPECT_FLOAT_EQ(curve->opacity(0.25F), 0.3F);
  EXPECT_FLOAT_EQ(curve->opacity(0.4F), 0.9F);
  EXPECT_FLOAT_EQ(curve->opacity(0.7F), 0.6F);
  EXPECT_FLOAT_EQ(curve->opacity(1), 0.5F);
}

// Slopes by hand: secants 2 and 0.5, mean 1.25 in the middle; alpha² + beta² ≤ 9 throughout.
TEST(TransferCurve, spline_has_the_hermite_polynomial_s_value) {
  const std::array<CurvePoint, 3> points{{{0, 0}, {0.25F, 0.5F}, {1, 0.875F}}};
  const auto curve = TransferCurve::spline(points);
  ASSERT_TRUE(curve);
  // Halfway a cubic Hermite piece has (p0 + p1) / 2 + width (m0 − m1) / 8.
  EXPECT_NEAR(curve->opacity(0.125F), 0.25 + 0.25 * (2 - 1.25) / 8, 1e-6);
  EXPECT_NEAR(curve->opacity(0.625F), 0.6875 + 0.75 * (1.25 - 0.5) / 8, 1e-6);
}

TEST(TransferCurve, spline_goes_through_its_points_and_is_monotone_between_them) {
  std::mt19937 random{7};
  std::uniform_real_distribution<float> unit{0, 1};
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<CurvePoint> points;
    float u = 0;
    while (u <= 1 && points.size() < TransferCurve::most_points) {
      points.push_back(
          {u, unit(random) < 0.2F && !points.empty() ? points.back().opacity : unit(random)});
      u += 0.01F + 0.3F * unit(random) * unit(random);
    }
    if (points.size() < 2)
      continue;
    const auto curve = TransferCurve::spline(points);
    ASSERT_TRUE(curve) << curve.error().message;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const CurvePoint& low = points[i];
      const CurvePoint& high = points[i + 1];
      ASSERT_NEAR(curve->opacity(low.u), low.opacity, 1e-6);
      float last = low.opacity;
      for (int k = 1; k <= 32; ++k) {
        const float here = curve->opacity(low.u + (high.u - low.u) * static_cast<float>(k) / 32);
        const float rise = (here - last) * (high.opacity >= low.opacity ? 1.0F : -1.0F);
        ASSERT_GE(rise, -2e-6F) << "overshoot in trial " << trial << ", segment " << i;
        last = here;
      }
    }
  }
}

TEST(TransferCurve, table_is_spread_evenly_over_the_window) {
  const std::array values{0.0F, 1.0F, 0.5F};
  const auto curve = TransferCurve::table(values);
  ASSERT_TRUE(curve);
  EXPECT_FLOAT_EQ(curve->opacity(0.25F), 0.5F);
  EXPECT_FLOAT_EQ(curve->opacity(0.5F), 1);
  EXPECT_FLOAT_EQ(curve->opacity(0.75F), 0.75F);
  EXPECT_FLOAT_EQ(curve->opacity(1), 0.5F);
}

TEST(TransferCurve, refuses_what_is_no_curve) {
  using Points = std::vector<CurvePoint>;
  EXPECT_THAT(TransferCurve::spline(Points{{0, 0}}), FailsSaying("found 1 points"));
  EXPECT_THAT(TransferCurve::spline(Points{{0, 0}, {0, 1}}), FailsSaying("u to rise"));
  EXPECT_THAT(TransferCurve::spline(Points{{0, 0}, {1, 1.5F}}), FailsSaying("point 2 is [1, 1.5]"));
  EXPECT_THAT(TransferCurve::spline(Points{{-0.1F, 0}, {1, 1}}), FailsSaying("point 1 is"));
  EXPECT_THAT(TransferCurve::spline(Points{{0, std::nanf("")}, {1, 1}}), FailsSaying("point 1 is"));
  EXPECT_THAT(TransferCurve::spline(Points(65)), FailsSaying("found 65 points"));
  EXPECT_FALSE(TransferCurve::table(std::array{0.5F}));
  EXPECT_FALSE(TransferCurve::table(std::array{0.5F, 1.1F}));
  EXPECT_FALSE(TransferCurve::table(std::vector<float>(4097)));
}

class TransferTables : public testing::Test {
protected:
  TransferTables() {
    view_.window_offset_db = 10;
    view_.window_size_db = 20;
    view_.opacity = 0.5F;
  }
  const TransferTable& make(const ui::TransferSet& set) {
    make_transfer_table(view_, set, *table_);
    return *table_;
  }
  static std::size_t entry_at(float db) {
    return static_cast<std::size_t>(pipeline::level_count(db) * TransferTable::entries_per_level);
  }

  ui::ViewState view_;
  std::unique_ptr<TransferTable> table_ = std::make_unique<TransferTable>();
};

TEST_F(TransferTables, the_first_function_in_grey_is_the_window_itself) {
  const TransferTable& made = make({});
  ASSERT_TRUE(made.window);
  const auto window = std::make_unique<TransferTable>();
  make_window_table(view_, *window);
  EXPECT_EQ(made.colour, window->colour);
  EXPECT_EQ(made.opacity, window->opacity);
}

TEST_F(TransferTables, a_colour_map_colours_the_window_s_ramp) {
  const ui::TransferSet set;
  view_.colour_map = *set.colour_map_named("amber");
  const TransferTable& made = make(set);
  EXPECT_FALSE(made.window) << "no mere ramp of grey";
  const std::size_t middle = entry_at(20);
  EXPECT_FLOAT_EQ(made.opacity[middle], 0.25F);
  EXPECT_EQ(made.colour[middle], set.colour_maps()[1].at(0.5F));
  EXPECT_EQ(made.opacity[entry_at(5)], 0);
  EXPECT_EQ(made.opacity[entry_at(40)], 0.5F);
}

TEST_F(TransferTables, colour_by_depth_leaves_the_levels_their_greys) {
  const ui::TransferSet set;
  EXPECT_FALSE(make(set).depths);
  view_.colour_map = *set.colour_map_named("depth");
  const TransferTable& made = make(set);
  EXPECT_EQ(made.depths, (ui::DepthColours{0, 1}));
  EXPECT_FALSE(made.window);
  EXPECT_EQ(made.colour[entry_at(20)], (TransferTable::Colour{0.5F, 0.5F, 0.5F}));
  view_.colour_map = 0;
  EXPECT_FALSE(make(set).depths) << "no longer";
}

TEST_F(TransferTables, the_window_s_knobs_steer_every_function) {
  const ui::TransferSet set;
  for (int i = 1; i < static_cast<int>(set.functions().size()); ++i) {
    view_.transfer = i;
    const TransferTable& made = make(set);
    const TransferCurve& curve = set.functions()[static_cast<std::size_t>(i)].curve;
    for (const float u : {0.0F, 0.25F, 0.5F, 0.8F, 1.0F}) {
      const std::size_t at = entry_at(10 + 20 * u);
      EXPECT_NEAR(made.opacity[at], 0.5F * curve.opacity(u), 1e-5) << i << " at " << u;
      const ui::ColourMap& colours = set.colours(view_);
      EXPECT_NEAR(made.colour[at].green, colours.at(u).green, 1e-5);
    }
  }
}

TEST_F(TransferTables, a_function_s_own_colours_give_way_to_a_chosen_map) {
  const ui::ColourMap own{"own", {{1, 0, 0}, {0, 0, 1}}};
  const auto set = ui::TransferSet{}.with({{"mine", TransferCurve::ramp(), own}});
  ASSERT_TRUE(set);
  view_.transfer = *set->function_named("mine");
  EXPECT_EQ(make(*set).colour[entry_at(20)], (TransferTable::Colour{0.5F, 0, 0.5F}));
  EXPECT_FALSE(make(*set).window);
  view_.colour_map = *set->colour_map_named("dawn");
  EXPECT_EQ(make(*set).colour[entry_at(20)], set->colour_maps()[3].at(0.5F));
}

TEST_F(TransferTables, an_index_that_is_not_there_means_the_first) {
  view_.transfer = 99;
  view_.colour_map = -1;
  EXPECT_TRUE(make({}).window);
}

TEST_F(TransferTables, allocate_nothing) {
  const ui::TransferSet set;
  const std::uint64_t before = allocations_of_this_thread();
  for (view_.transfer = 0; view_.transfer < 3; ++view_.transfer)
    for (view_.colour_map = 0; view_.colour_map < 5; ++view_.colour_map)
      make(set);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST(TransferSet, names_are_unique) {
  std::vector<ui::TransferFunction> two{{"twice", TransferCurve::ramp(), {}},
                                        {"twice", TransferCurve::ramp(), {}}};
  EXPECT_THAT(ui::TransferSet{}.with(std::move(two)), FailsSaying("\"twice\" is there already"));
}

} // namespace
} // namespace octascope::tests
