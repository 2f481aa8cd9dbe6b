#include <vector>

#include <gtest/gtest.h>

#include "pipeline/volume/upper_border.h"

namespace octascope::pipeline {
namespace {

constexpr int depths = 128;
constexpr int a_scans = 40;

// Counts of one B-scan: a floor, and in the first `with_tissue` A-scans tissue from `from` to `to`.
std::vector<std::uint8_t> b_scan(int with_tissue, int from, int to, std::uint8_t tissue,
                                 std::uint8_t floor = 40) {
  std::vector<std::uint8_t> levels(std::size_t{depths} * a_scans, floor);
  for (int a = 0; a < with_tissue; ++a)
    for (int z = from; z < to; ++z)
      levels[static_cast<std::size_t>(a * depths + z)] = tissue;
  return levels;
}

BorderCount count(const std::vector<std::uint8_t>& levels) {
  return count_at_upper_border(levels, depths, a_scans);
}

TEST(UpperBorder, counts_the_a_scans_whose_tissue_reaches_it) {
  const BorderCount found = count(b_scan(10, 0, 60, 90));
  EXPECT_EQ(found.looked_at, a_scans);
  EXPECT_EQ(found.lit, 10);
  EXPECT_TRUE(is_at_upper_border(found));
  EXPECT_EQ(count(b_scan(10, 12, 60, 90)).lit, 0) << "a gap above it";
  EXPECT_EQ(count(b_scan(0, 0, 60, 90)).lit, 0) << "nothing there";
}

TEST(UpperBorder, is_not_lit_by_what_the_background_leaves) {
  EXPECT_EQ(count(b_scan(a_scans, 0, 4, 200)).lit, 0);
}

TEST(UpperBorder, needs_fifteen_decibels_above_the_floor) {
  EXPECT_EQ(count(b_scan(10, 0, 60, 40 + 29)).lit, 0);
  EXPECT_EQ(count(b_scan(10, 0, 60, 40 + 30)).lit, 10);
}

TEST(UpperBorder, is_not_lit_by_the_tails_of_tissue_far_brighter) {
  auto levels = b_scan(a_scans, 60, 80, 120);
  for (int a = 0; a < a_scans; ++a)
    for (int z = 0; z < 30; ++z)
      levels[static_cast<std::size_t>(a * depths + z)] = 120 - 31;
  EXPECT_EQ(count(levels).lit, 0);
  for (int a = 0; a < a_scans; ++a)
    for (int z = 0; z < 30; ++z)
      levels[static_cast<std::size_t>(a * depths + z)] = 120 - 30;
  EXPECT_EQ(count(levels).lit, a_scans);
}

TEST(UpperBorder, is_told_from_a_twentieth_of_the_a_scans_on) {
  EXPECT_FALSE(is_at_upper_border({.looked_at = 5120, .lit = 255}));
  EXPECT_TRUE(is_at_upper_border({.looked_at = 5120, .lit = 256}));
  EXPECT_FALSE(is_at_upper_border({})) << "nothing was looked at";
}

TEST(UpperBorder, looks_at_some_of_many_a_scans_evenly) {
  for (const int many : {1, 63, 64, 65, 300, 4096}) {
    std::vector<std::uint8_t> levels(static_cast<std::size_t>(many) * depths, 40);
    for (int a = 0; a < many / 2; ++a)
      std::fill_n(levels.begin() + a * depths, 60, std::uint8_t{90});
    const BorderCount found = count_at_upper_border(levels, depths, many);
    EXPECT_EQ(found.looked_at, std::min(many, 64));
    EXPECT_NEAR(found.lit, found.looked_at / 2.0, 1) << many;
  }
}

TEST(UpperBorder, of_few_depths_is_not_looked_at) {
  const std::vector<std::uint8_t> levels(47 * 3, 90);
  EXPECT_EQ(count_at_upper_border(levels, 47, 3).looked_at, 0);
  EXPECT_EQ(count_at_upper_border({}, 128, 0).looked_at, 0);
}

} // namespace
} // namespace octascope::pipeline
