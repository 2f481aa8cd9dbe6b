// The measure that golden pictures of texture are held to: its values in closed form, and what it
// lets pass and what not.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/program/built_places.h"
#include "tests/ui/support/golden.h"
#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/structural_similarity.h"

namespace octascope::tests {
namespace {

pipeline::Image grey_picture(int width, int height, auto&& level) {
  pipeline::Image image{width, height, 3};
  std::size_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.pixels[i++] = static_cast<std::uint8_t>(level(x, y));
  return image;
}

pipeline::Image checks(int low, int high) {
  return grey_picture(40, 30, [=](int x, int y) { return (x + y) % 2 == 0 ? low : high; });
}

pipeline::Image golden(const std::string& name) {
  auto read = pipeline::read_png(source_folder() / "tests/golden" / (name + ".png"));
  EXPECT_TRUE(read);
  return read ? std::move(*read) : pipeline::Image{};
}

// Channel by channel, from the pixels at (x, y) and dx beside it.
pipeline::Image mixed_with_neighbour(const pipeline::Image& from, double share) {
  pipeline::Image image = from;
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x + 1 < from.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const std::size_t i =
            3 * static_cast<std::size_t>(y * from.width + x) + static_cast<std::size_t>(c);
        image.pixels[i] = static_cast<std::uint8_t>(
            std::lround((1 - share) * from.pixels[i] + share * from.pixels[i + 3]));
      }
  return image;
}

TEST(StructuralSimilarity, is_1_for_equal_pictures) {
  EXPECT_DOUBLE_EQ(structural_similarity(checks(20, 220), checks(20, 220)), 1);
}

// Two flat pictures differ in luminance alone: (2ab + C1) / (a² + b² + C1).
TEST(StructuralSimilarity, of_flat_pictures_is_the_luminance_term) {
  const auto flat = [](int level) { return grey_picture(20, 20, [=](int, int) { return level; }); };
  const double c1 = 2.55 * 2.55;
  EXPECT_NEAR(structural_similarity(flat(100), flat(140)),
              (2.0 * 100 * 140 + c1) / (100.0 * 100 + 140.0 * 140 + c1), 1e-9);
}

// The opposite of a pattern about the same mean: the structure term is −1 but for C2.
TEST(StructuralSimilarity, of_a_pattern_and_its_negative_is_almost_minus_1) {
  const double similarity = structural_similarity(checks(28, 228), checks(228, 28));
  EXPECT_LT(similarity, -0.98);
  EXPECT_GT(similarity, -1);
}

// Beside a large empty ground, too, the part that differs decides.
TEST(StructuralSimilarity, is_not_drowned_by_an_empty_ground) {
  const auto corner = [](int phase) {
    return grey_picture(200, 200, [=](int x, int y) {
      return x < 30 && y < 30 ? ((x + y + phase) % 2 == 0 ? 20 : 220) : 8;
    });
  };
  EXPECT_LT(structural_similarity(corner(0), corner(1)), 0);
}

class KeptPicture : public testing::TestWithParam<std::string> {};

TEST_P(KeptPicture, fails_when_moved_by_a_pixel_or_blurred_and_not_for_rounding) {
  const pipeline::Image kept = golden("techniques/" + GetParam() + "_320x180");
  ASSERT_FALSE(kept.pixels.empty());
  EXPECT_LT(structural_similarity(kept, mixed_with_neighbour(kept, 1)), golden_similarity);
  EXPECT_LT(structural_similarity(kept, mixed_with_neighbour(kept, 0.5)), golden_similarity);
  pipeline::Image rounded = kept;
  for (std::size_t i = 0; i < rounded.pixels.size(); ++i)
    rounded.pixels[i] =
        static_cast<std::uint8_t>(std::min(255, rounded.pixels[i] + static_cast<int>(i / 3 % 2)));
  EXPECT_GT(structural_similarity(kept, rounded), golden_similarity);
}

INSTANTIATE_TEST_SUITE_P(Techniques, KeptPicture,
                         testing::Values("anterior_eye_slices", "anterior_eye_planes",
                                         "anterior_eye_rays", "anterior_eye_shaded",
                                         "anterior_eye_maximum", "anterior_eye_surface",
                                         "nail_fold_rays", "cap_rays", "tissue_rays"),
                         [](const auto& test) { return test.param; });

} // namespace
} // namespace octascope::tests
