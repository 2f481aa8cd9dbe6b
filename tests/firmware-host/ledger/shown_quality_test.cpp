// Median and worst quality of frames, against sorted values.
#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "firmware-host/ledger/shown_quality.h"
#include "tests/support/files/fresh_seed.h"
#include "ui/pacing/governor.h"

namespace octascope::tests {
namespace {

using firmware_host::QualityRange;
using firmware_host::QualitySummary;
using firmware_host::ShownQuality;
using ui::Technique;

QualityRange range_of(std::vector<double> values) {
  std::ranges::sort(values);
  return {values[(values.size() - 1) / 2], values.front()};
}

TEST(ShownQuality, of_no_frame_is_nothing) {
  const QualitySummary none = ShownQuality{}.summary();
  EXPECT_EQ(none.frames, 0U);
  EXPECT_FALSE(none.resolution);
  EXPECT_FALSE(none.steps);
}

TEST(ShownQuality, is_the_median_and_the_worst_of_what_was_added) {
  std::mt19937 random{fresh_seed()};
  const auto ladder = ui::quality_ladder();
  for (std::size_t count = 1; count < 60; ++count) {
    ShownQuality shown;
    std::vector<double> resolutions;
    std::vector<double> steps;
    for (std::size_t i = 0; i < count; ++i) {
      const ui::DrawQuality& quality = ladder[random() % ladder.size()];
      shown.add(Technique::rays, quality);
      resolutions.push_back(static_cast<double>(quality.resolution));
      steps.push_back(quality.steps);
    }
    const QualitySummary summary = shown.summary();
    EXPECT_EQ(summary.frames, count);
    ASSERT_TRUE(summary.resolution);
    EXPECT_NEAR(summary.resolution->median, range_of(resolutions).median, 1e-6);
    EXPECT_NEAR(summary.resolution->worst, range_of(resolutions).worst, 1e-6);
    EXPECT_EQ(summary.steps, range_of(steps));
  }
}

TEST(ShownQuality, of_a_surface_has_no_steps) {
  ShownQuality shown;
  shown.add(Technique::surface, {0.5F, 192});
  EXPECT_EQ(shown.summary().resolution, (QualityRange{0.5, 0.5}));
  EXPECT_FALSE(shown.summary().steps);
  shown.add(Technique::planes, {1, 512});
  EXPECT_EQ(shown.summary().steps, (QualityRange{512, 512}));
}

} // namespace
} // namespace octascope::tests
