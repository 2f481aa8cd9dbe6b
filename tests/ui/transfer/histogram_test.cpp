#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/volume/level_scale.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/transfer/auto_window.h"
#include "ui/transfer/histogram.h"

namespace octascope::tests {
namespace {

std::uint64_t sum(const ui::LevelHistogram& histogram) {
  return std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::uint64_t{0});
}

TEST(LevelHistogram, counts_every_voxel_of_a_small_volume_but_the_blank_bins_and_the_missing) {
  pipeline::Volume volume = uniform_volume({10, 7, 3, 1, 1, 1}, 0);
  std::array<std::uint32_t, 256> expected{};
  std::mt19937 random{1};
  for (std::size_t i = 0; i < volume.levels.size(); ++i) {
    const auto level = static_cast<std::uint8_t>(random());
    volume.levels[i] = level;
    if (i % 10 >= 2 && i / 70 != 1)
      ++expected[level];
  }
  volume.b_scan_states[1] = pipeline::BScanState::missing;
  EXPECT_EQ(ui::make_level_histogram(volume).counts, expected);
}

TEST(LevelHistogram, of_a_large_volume_looks_at_some_everywhere) {
  pipeline::Volume volume{full_geometry};
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
  for (int b = 0; b < 80; ++b)
    std::ranges::fill(volume.b_scan(b), static_cast<std::uint8_t>(b + 1));
  const ui::LevelHistogram histogram = ui::make_level_histogram(volume);
  EXPECT_LE(sum(histogram), 1U << 19U);
  EXPECT_GE(sum(histogram), 1U << 18U);
  const auto [least, most] =
      std::minmax_element(histogram.counts.begin() + 1, histogram.counts.begin() + 81);
  EXPECT_GT(*least, 0U);
  EXPECT_LE(*most - *least, 510U) << "one A-scan more or less of each B-scan";
}

TEST(LevelHistogram, shares_are_roots_over_decibels) {
  ui::LevelHistogram histogram;
  EXPECT_EQ(histogram.shares(), (std::array<float, 128>{}));
  histogram.counts[0] = 1'000'000;
  histogram.counts[20] = 60;
  histogram.counts[21] = 40;
  histogram.counts[255] = 25;
  const auto shares = histogram.shares();
  EXPECT_EQ(shares[0], 0) << "nothing at all is no level";
  EXPECT_EQ(shares[10], 1);
  EXPECT_FLOAT_EQ(shares[127], 0.5F);
  EXPECT_EQ(std::ranges::count_if(shares, [](float s) { return s > 0; }), 2);
}

using Levels = std::normal_distribution<float>;

// Tissue in one voxel of so many, noise in the others; or the other way round.
pipeline::Volume speckled(Levels one, std::size_t of, Levels others) {
  pipeline::Volume volume = uniform_volume({100, 60, 40, 1, 1, 1}, 0);
  std::mt19937 random{5};
  for (std::size_t i = 0; i < volume.levels.size(); ++i)
    volume.levels[i] = static_cast<std::uint8_t>(i % of == 0 ? one(random) : others(random));
  return volume;
}

// Two thirds tissue: its peak is the higher one, and no noise.
TEST(SuggestedWindow, takes_no_tissue_for_noise) {
  const auto window = ui::suggest_window(speckled(Levels{45, 6}, 3, Levels{90, 9}));
  ASSERT_TRUE(window);
  EXPECT_NEAR(window->offset_db, pipeline::level_db(57), 2.1);
}

// Noise with a standard deviation of 6 counts around 60, tissue around 150 in a tenth of it.
TEST(SuggestedWindow, begins_above_the_noise_and_ends_at_the_brightest) {
  pipeline::Volume volume = speckled(Levels{150, 10}, 10, Levels{60, 6});
  const auto window = ui::suggest_window(volume);
  ASSERT_TRUE(window);
  EXPECT_NEAR(window->offset_db, pipeline::level_db(72), 2.1);
  EXPECT_NEAR(window->offset_db + window->size_db, pipeline::level_db(173), 3);
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::missing);
  EXPECT_FALSE(ui::suggest_window(volume));
}

} // namespace
} // namespace octascope::tests
