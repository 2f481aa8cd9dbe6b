// The measure that golden pictures of texture are held to: what it lets pass and what not.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/program/built_places.h"
#include "tests/ui/support/golden.h"
#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/structural_similarity.h"

namespace octascope::tests {
namespace {

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
