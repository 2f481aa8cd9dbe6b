// The first picture: calm, legible, in the middle, and nothing of GL left behind.
#include <algorithm>

#include "tests/ui/support/gl_test.h"
#include "ui/canvas/palette.h"
#include "ui/splash.h"

namespace octascope::tests {
namespace {

constexpr int width = 640;
constexpr int height = 360;

class SplashTest : public GlTest {
protected:
  std::vector<std::uint8_t> draw(std::string_view doing) {
    EXPECT_TRUE(ui::draw_splash(width, height, "1.2.3", doing));
    std::vector<std::uint8_t> rgba(std::size_t{4} * width * height);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  }

  // Pixels brighter than half in the rows [from, to) of the picture, counted from its top.
  static long bright(const std::vector<std::uint8_t>& rgba, int from, int to) {
    long count = 0;
    for (int y = height - to; y < height - from; ++y)
      for (int x = 0; x < width; ++x)
        count +=
            rgba[4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) + 1] > 127;
    return count;
  }
};

TEST_F(SplashTest, says_the_name_in_the_middle_of_a_dark_screen) {
  const auto rgba = draw("starting");
  EXPECT_EQ(rgba[0], ui::palette::background.r);
  EXPECT_GT(bright(rgba, height / 4, 3 * height / 4), 200);
  EXPECT_EQ(bright(rgba, 0, height / 4), 0);
  EXPECT_LT(bright(rgba, 0, height), width * height / 20);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(SplashTest, says_what_it_waits_for) {
  EXPECT_NE(draw("starting"), draw("looking for the camera"));
}

} // namespace
} // namespace octascope::tests
