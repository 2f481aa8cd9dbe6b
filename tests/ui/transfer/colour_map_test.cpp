// Whether the colour maps keep what they promise to the eye.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "ui/transfer/oklab.h"
#include "ui/transfer/transfer_set.h"

namespace octascope::tests {
namespace {

using Colour = ui::TransferTable::Colour;
using Matrix = std::array<std::array<double, 3>, 3>;

// What dichromats see, on linear RGB: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A
// physiologically-based model for simulation of color vision deficiency" (IEEE TVCG 15, 2009), at
// severity 1.
constexpr Matrix protanopia{{{0.152286, 1.052583, -0.204868},
                             {0.114503, 0.786281, 0.099216},
                             {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix deuteranopia{{{0.367322, 0.860646, -0.227968},
                               {0.280085, 0.672501, 0.047413},
                               {-0.011820, 0.042940, 0.968881}}};
constexpr Matrix all_cones{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

double linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// CIE 1976 L*, 0…100, of sRGB as somebody with these cones sees it.
double lightness(const Colour& colour, const Matrix& cones) {
  const std::array rgb{linear(static_cast<double>(colour.red)),
                       linear(static_cast<double>(colour.green)),
                       linear(static_cast<double>(colour.blue))};
  constexpr std::array shares{0.2126, 0.7152, 0.0722};
  double y = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double channel = 0;
    for (std::size_t k = 0; k < 3; ++k)
      channel += cones[i][k] * rgb[k];
    y += shares[i] * std::clamp(channel, 0.0, 1.0);
  }
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

class ColourMaps : public testing::Test {
protected:
  ui::TransferSet set_;
};

TEST_F(ColourMaps, are_grey_and_three_more) {
  ASSERT_EQ(set_.colour_maps().size(), 4U);
  for (const float u : {0.0F, 0.3F, 1.0F})
    EXPECT_EQ(set_.colour_maps()[0].at(u), (Colour{u, u, u}));
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
  for (const ui::ColourMap& map : set_.colour_maps().subspan(1)) {
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
    for (const Matrix& cones : {all_cones, protanopia, deuteranopia}) {
      double last = lightness(map.at(0), cones);
      for (int i = 1; i <= 32; ++i) {
        const double here = lightness(map.at(static_cast<float>(i) / 32), cones);
        EXPECT_GT(here, last + 0.6) << map.name() << " at " << i << "/32";
        last = here;
      }
      EXPECT_GT(last, 85) << map.name();
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
