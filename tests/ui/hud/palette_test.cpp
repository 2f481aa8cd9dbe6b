// Whether the display's colours can be read and told apart.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/ui/support/colour_vision.h"
#include "ui/canvas/palette.h"
#include "ui/view/vessel_look.h"

namespace octascope::tests {
namespace {

using namespace ui;

// What one sees of a plate that lets a little of the picture through.
Colour over(Colour plate, std::uint8_t picture) {
  const auto mix = [&](std::uint8_t value) {
    return static_cast<std::uint8_t>((value * plate.a + picture * (255 - plate.a)) / 255);
  };
  return {mix(plate.r), mix(plate.g), mix(plate.b)};
}

std::string words(Colour c) {
  return fmt::format("({}, {}, {})", c.r, c.g, c.b);
}

// Level AAA of WCAG 2 for text of any size.
TEST(Palette, every_text_has_a_contrast_of_seven_over_black_and_over_white) {
  for (const auto& [text, ground] : palette::texts_on_grounds)
    for (const std::uint8_t picture : {std::uint8_t{0}, std::uint8_t{255}})
      EXPECT_GE(contrast(text, over(ground, picture)), 7)
          << words(text) << " on " << words(ground) << " over " << int{picture};
}

TEST(Palette, contrast_is_that_of_wcag) {
  EXPECT_NEAR(contrast({255, 255, 255}, {0, 0, 0}), 21, 1e-9);
  EXPECT_NEAR(contrast({118, 118, 118}, {255, 255, 255}), 4.54, 0.005); // a well-known border case
  EXPECT_EQ(contrast({1, 2, 3}, {200, 100, 50}), contrast({200, 100, 50}, {1, 2, 3}));
}

// A difference of 2.3 is just noticed (M. Mahy et al., Color Research and Application 19, 1994);
// states are to be told apart at a glance and far from each other on the screen.
TEST(Palette, states_are_told_apart_by_every_kind_of_eye) {
  constexpr double least = 18;
  for (const Vision& vision : all_visions)
    for (std::size_t i = 0; i < palette::states.size(); ++i)
      for (std::size_t k = i + 1; k < palette::states.size(); ++k)
        EXPECT_GE(seen_difference(palette::states[i], palette::states[k], vision), least)
            << words(palette::states[i]) << " and " << words(palette::states[k]) << ", "
            << vision.name;
}

TEST(Palette, main_branches_of_vessels_are_told_apart_by_every_kind_of_eye) {
  const auto shown = [](std::size_t branch) {
    const VesselColour& colour = branch_colours[branch];
    const auto bits = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5F); };
    return Colour{bits(colour[0]), bits(colour[1]), bits(colour[2])};
  };
  for (std::size_t i = 1; i < branch_colours.size(); ++i) {
    EXPECT_GE(contrast(shown(i), palette::panel), 3) << i;
    for (const Vision& vision : all_visions)
      for (std::size_t k = i + 1; k < branch_colours.size(); ++k)
        EXPECT_GE(seen_difference(shown(i), shown(k), vision), 18) << vision.name;
  }
}

TEST(Palette, the_simulation_confuses_what_colour_blind_people_confuse) {
  const auto apart = [](Colour a, Colour b, std::size_t vision) {
    return seen_difference(a, b, all_visions[vision]);
  };
  constexpr Colour red{200, 90, 60};
  constexpr Colour green{120, 130, 50};
  EXPECT_GT(apart(red, green, 0), 3 * apart(red, green, 2));
  constexpr Colour blue{60, 150, 220};
  constexpr Colour teal{60, 165, 160};
  EXPECT_GT(apart(blue, teal, 0), 2 * apart(blue, teal, 3));
  for (std::size_t i = 0; i < all_visions.size(); ++i) // white stays white
    EXPECT_LT(seen_difference({255, 255, 255}, {255, 255, 255}, all_visions[i]), 1e-9);
  for (const Vision& vision : all_visions)
    EXPECT_NEAR(seen_lab({255, 255, 255}, vision).x, 100, 0.1) << vision.name;
}

} // namespace
} // namespace octascope::tests
