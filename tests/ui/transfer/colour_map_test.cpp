// Whether the colour maps keep what they promise to the eye.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "tests/ui/support/colour_vision.h"
#include "ui/transfer/oklab.h"
#include "ui/transfer/transfer_set.h"

namespace octascope::tests {
namespace {

using Colour = ui::TransferTable::Colour;

class ColourMaps : public testing::Test {
protected:
  ui::TransferSet set_;
};

TEST_F(ColourMaps, are_grey_three_more_and_grey_with_the_hue_of_the_depth) {
  ASSERT_EQ(set_.colour_maps().size(), 5U);
  for (const float u : {0.0F, 0.3F, 1.0F})
    for (const std::size_t map : {0U, 4U})
      EXPECT_EQ(set_.colour_maps()[map].at(u), (Colour{u, u, u}));
  for (const ui::ColourMap& map : set_.colour_maps())
    EXPECT_EQ(map.by_depth(), map.name() == "depth");
}

TEST_F(ColourMaps, stay_within_what_a_display_shows) {
  for (const ui::ColourMap& map : set_.colour_maps())
    for (int i = 0; i <= 1000; ++i) {
      const Colour colour = map.at(static_cast<float>(i) / 1000);
      for (const float channel : {colour.red, colour.green, colour.blue}) {
        ASSERT_GE(channel, -0.5F / 255) << map.name() << " at " << i;
        ASSERT_LE(channel, 1 + 0.5F / 255) << map.name() << " at " << i;
      }
    }
}

// To the display's 8 bits, lightness rises by the same everywhere.
TEST_F(ColourMaps, rise_linearly_in_lightness) {
  for (const ui::ColourMap& map : set_.colour_maps().subspan(1, 3)) {
    const float first = to_oklab(map.at(0)).lightness;
    const float last = to_oklab(map.at(1)).lightness;
    EXPECT_LT(first, 0.12F);
    EXPECT_GT(last, 0.9F);
    for (int i = 0; i <= 64; ++i) {
      const float u = static_cast<float>(i) / 64;
      EXPECT_NEAR(to_oklab(map.at(u)).lightness, first + (last - first) * u, 2e-3)
          << map.name() << " at " << u;
    }
  }
}

TEST_F(ColourMaps, keep_their_order_to_the_colour_blind) {
  for (const ui::ColourMap& map : set_.colour_maps())
    for (const Vision& vision : std::span{all_visions}.first(3)) { // the fourth is rare
      const auto lightness = [&](float u) {
        const Colour colour = map.at(u);
        return seen_lab_of_srgb(glm::dvec3{colour.red, colour.green, colour.blue}, vision).x;
      };
      double last = lightness(0);
      for (int i = 1; i <= 32; ++i) {
        const double here = lightness(static_cast<float>(i) / 32);
        EXPECT_GT(here, last + 0.6) << map.name() << " at " << i << "/32";
        last = here;
      }
      EXPECT_GT(last, 85) << map.name();
    }
}

// A brightness means the same at any depth.
TEST(DepthColours, are_equally_light_and_can_be_shown) {
  for (int i = 0; i <= 100; ++i) {
    const auto [red, green, blue] = ui::depth_tint(static_cast<float>(i) / 100);
    for (const float channel : {red, green, blue}) {
      EXPECT_GE(channel, 0) << i;
      EXPECT_LE(channel, 1) << i;
    }
    EXPECT_NEAR(ui::to_oklab({red, green, blue}).lightness, 0.768F, 0.013F) << i;
  }
}

TEST(GlidingDepths, begin_with_the_first_and_then_move_without_a_jump) {
  ui::GlidingDepths depths;
  depths.follow({0.25F, 0.75F});
  EXPECT_EQ(depths.current(), (ui::DepthColours{0.25F, 0.75F}));
  const ui::DepthColours wanted{0.125F, 0.75F};
  float before = depths.current().from;
  int volumes = 0;
  for (; depths.current() != wanted && volumes < 100; ++volumes) {
    depths.follow(wanted);
    EXPECT_LT(depths.current().from, before);
    EXPECT_LE(before - depths.current().from, 0.125F / 4 + 1e-6F);
    EXPECT_EQ(depths.current().to, wanted.to) << "what does not change stays";
    before = depths.current().from;
  }
  EXPECT_LE(volumes, 20) << "and they arrive, so that pictures are kept again";
}

TEST(DepthColours, differ_from_depth_to_depth_for_the_colour_blind_too) {
  constexpr int steps = 3;
  for (const Vision& vision : std::span{all_visions}.first(3)) // the fourth is rare
    for (int i = 0; i <= steps; ++i)
      for (int k = 0; k < i; ++k) {
        const auto seen = [&](int at) {
          const auto [red, green, blue] = ui::depth_tint(static_cast<float>(at) / steps);
          return seen_lab_of_srgb(glm::dvec3{red, green, blue}, vision);
        };
        EXPECT_GT(glm::distance(seen(i), seen(k)), 8) << vision.name << ' ' << i << ' ' << k;
      }
}

TEST(Oklab, has_the_published_values) {
  const ui::Oklab white = ui::to_oklab({1, 1, 1});
  EXPECT_NEAR(white.lightness, 1, 1e-4);
  EXPECT_NEAR(white.a, 0, 1e-4);
  EXPECT_NEAR(white.b, 0, 1e-4);
  const ui::Oklab red = ui::to_oklab({1, 0, 0});
  EXPECT_NEAR(red.lightness, 0.62796, 1e-4);
  EXPECT_NEAR(red.a, 0.22486, 1e-4);
  EXPECT_NEAR(red.b, 0.12585, 1e-4);
  for (const Colour& colour : {Colour{0.2F, 0.5F, 0.9F}, Colour{0.9F, 0.8F, 0.1F}}) {
    const Colour back = ui::to_srgb(ui::to_oklab(colour));
    EXPECT_NEAR(back.red, colour.red, 1e-4);
    EXPECT_NEAR(back.green, colour.green, 1e-4);
    EXPECT_NEAR(back.blue, colour.blue, 1e-4);
  }
}

} // namespace
} // namespace octascope::tests
