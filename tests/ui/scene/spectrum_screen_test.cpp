// The live spectrum: all words in their places, the curve where its counts are, what is saturated marked.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "tests/ui/support/gl_test.h"
#include "ui/canvas/palette.h"
#include "ui/layout/layout.h"
#include "ui/spectrum_screen.h"

namespace octascope::tests {
namespace {

using namespace ui;

constexpr int width = 1280;
constexpr int height = 720;
constexpr double full_scale = 4095;

const std::array<SpectrumFigure, 5> all_bad{
    {{"Brightest sample", "100 % full", "40 to 80 %", "less light, shorter exposure"},
     {"Saturated lines", "100.0 %", "0 %", "less light, shorter exposure"},
     {"Fringe contrast", "100.0 %", "5 % and more, with a mirror",
      "see overlap, polarisation, depth"},
     {"Dark level", "65535 of 65535 counts", "the camera's own offset"},
     {"Frames lost, broken", "1000, 1000 of 1000", "0, 0", "see cable and other programs"}}};

class SpectrumScreenTest : public GlTest {
protected:
  void SetUp() override { open(width, height); }

  std::vector<std::uint8_t> draw(const LiveSpectrum& spectrum) {
    auto screen = SpectrumScreen::create(width, height);
    EXPECT_TRUE(screen) << screen.error().message;
    screen->draw(spectrum);
    std::vector<std::uint8_t> rgba(std::size_t{4} * width * height);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return rgba;
  }

  // Rows of the picture, counted from its top, in which that column has the colour.
  static std::vector<int> rows(const std::vector<std::uint8_t>& rgba, int column, Colour colour) {
    std::vector<int> found;
    for (int y = 0; y < height; ++y) {
      const std::uint8_t* pixel = &rgba[4 * (static_cast<std::size_t>(height - 1 - y) * width +
                                             static_cast<std::size_t>(column))];
      if (pixel[0] == colour.r && pixel[1] == colour.g && pixel[2] == colour.b)
        found.push_back(y);
    }
    return found;
  }
};

TEST_F(SpectrumScreenTest, has_room_for_all_words) {
  const std::vector<double> line(2048, full_scale);
  for (const auto& [w, h] :
       {std::pair{640, 360}, {1280, 720}, {1024, 768}, {1920, 1080}, {3840, 2160}}) {
    SCOPED_TRACE(w);
    const float unit = lay_out(w, h, {}).unit;
    const auto fonts = Fonts::create(unit);
    ASSERT_TRUE(fonts) << fonts.error().message;
    Canvas canvas;
    canvas.begin(*fonts, w, h);
    lay_out_spectrum(canvas, w, h, unit, {line, line, line, full_scale, 0, all_bad});
    const auto words = canvas.words();
    EXPECT_GE(words.size(), 4 * all_bad.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
      EXPECT_EQ(common(words[i].rect, {0, 0, w, h}), words[i].rect) << i;
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_TRUE(common(words[i].rect, words[k].rect).empty()) << i << " and " << k;
    }
  }
}

// Counts are on a linear axis: half of full scale lies between nothing and full scale.
TEST_F(SpectrumScreenTest, draws_the_mean_at_its_counts) {
  const auto middle_of = [&](double counts) {
    const std::vector<double> line(1024, counts);
    const auto found = rows(draw({line, {}, line, full_scale, 0, {}}), 400, palette::accent);
    EXPECT_FALSE(found.empty()) << counts;
    return found.empty() ? 0 : (found.front() + found.back()) / 2;
  };
  const int none = middle_of(0);
  const int half = middle_of(full_scale / 2);
  const int full = middle_of(full_scale - 1);
  EXPECT_GT(none - full, height / 2);
  EXPECT_NEAR(half, (none + full) / 2.0, 1.5);
}

TEST_F(SpectrumScreenTest, marks_the_pixels_that_are_saturated_and_no_others) {
  const std::vector<double> mean(1024, full_scale / 2);
  std::vector<double> highest = mean;
  const auto without = draw({mean, mean, highest, full_scale, 0, {}});
  std::fill(highest.begin(), highest.begin() + 512, full_scale);
  const auto with = draw({mean, mean, highest, full_scale, 0, {}});
  const auto changed = [&](int column) {
    int count = 0;
    for (int y = 0; y < height; ++y) {
      const auto at = static_cast<std::ptrdiff_t>(
          4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(column)));
      count += !std::equal(with.begin() + at, with.begin() + at + 4, without.begin() + at);
    }
    return count;
  };
  EXPECT_GT(changed(200), height / 2);
  EXPECT_EQ(changed(700), 0);
}

} // namespace
} // namespace octascope::tests
