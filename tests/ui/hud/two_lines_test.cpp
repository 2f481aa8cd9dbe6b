#include <string>

#include <gtest/gtest.h>

#include "ui/hud/two_lines.h"

namespace octascope::tests {
namespace {

ui::TwoLines broken(std::string_view words, float most) {
  return ui::break_to_fit(words, most,
                          [](std::string_view text) { return static_cast<float>(text.size()); });
}

constexpr std::string_view words = "The scanner misses pulses: volumes are lost";

TEST(TwoLines, what_fits_is_one_line) {
  EXPECT_EQ(broken(words, 43).first, words);
  EXPECT_EQ(broken(words, 43).second, "");
  EXPECT_EQ(broken("", 0).first, "");
}

TEST(TwoLines, break_between_words_and_lose_none) {
  for (int most = 24; most < 43; ++most) {
    SCOPED_TRACE(most);
    const ui::TwoLines lines = broken(words, static_cast<float>(most));
    EXPECT_LE(lines.first.size(), static_cast<std::size_t>(most));
    EXPECT_LE(lines.second.size(), static_cast<std::size_t>(most));
    EXPECT_EQ(std::string{lines.first} + " " + std::string{lines.second}, words);
  }
  EXPECT_EQ(broken(words, 26).first, "The scanner misses pulses:") << "as much as fits";
}

TEST(TwoLines, a_word_that_does_not_fit_is_left_whole) {
  EXPECT_EQ(broken("Microscope", 4).first, "Microscope");
  EXPECT_EQ(broken("Microscope camera", 4).first, "Microscope camera");
}

} // namespace
} // namespace octascope::tests
