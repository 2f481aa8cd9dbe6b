#include "tests/ui/support/golden.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/program/built_places.h"
#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/structural_similarity.h"

namespace octascope::tests {

namespace {

constexpr double most_mean = 1.5;
constexpr double most_outliers = 0.005;
constexpr int outlier = 40;

double share_of_outliers(const pipeline::Image& a, const pipeline::Image& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    count += std::abs(int{a.pixels[i]} - int{b.pixels[i]}) > outlier ? 1U : 0U;
  return static_cast<double>(count) / static_cast<double>(a.pixels.size());
}

} // namespace

void expect_golden(const pipeline::Image& image, const std::string& name, double least_similarity) {
  const auto file = source_folder() / "tests/golden" / (name + ".png");
  if (std::getenv("OCTASCOPE_RENEW_GOLDEN") != nullptr) {
    ASSERT_TRUE(pipeline::write_png(file, image)) << file;
    return;
  }
  const auto golden = pipeline::read_png(file);
  ASSERT_TRUE(golden) << "no " << file << "; run with OCTASCOPE_RENEW_GOLDEN=1 and look at it";
  ASSERT_EQ(golden->width, image.width);
  ASSERT_EQ(golden->height, image.height);
  const PictureDifference difference = compare(image, *golden);
  const double outliers = share_of_outliers(image, *golden);
  const double similarity = least_similarity > 0 ? structural_similarity(image, *golden) : 1;
  std::string flat_name = name;
  std::ranges::replace(flat_name, '/', '_');
  const auto found = picture_folder() / (flat_name + "_found.png");
  if (difference.mean > most_mean || outliers > most_outliers || similarity < least_similarity)
    static_cast<void>(pipeline::write_png(found, image));
  EXPECT_LE(difference.mean, most_mean) << "largest " << difference.largest << "; see " << found;
  EXPECT_LE(outliers, most_outliers) << "see " << found;
  EXPECT_GE(similarity, least_similarity) << "see " << found;
}

} // namespace octascope::tests
