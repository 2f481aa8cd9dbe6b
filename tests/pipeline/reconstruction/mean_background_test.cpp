// The mean of a B-scan's lines, exact; and its interpolation for the fused path.
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/calibration/k_linearisation.h"
#include "pipeline/reconstruction/background.h"
#include "pipeline/reconstruction/fused/fused_tables.h"
#include "tests/support/files/calibrations.h"

namespace octascope::pipeline {
namespace {

// Counts up to the highest that there is, lines whose tail fills no register, and numbers of lines
// that do not divide.
template <class Count> void expect_exact_mean(int right_shift) {
  std::mt19937 generator{29};
  for (const int line_samples : {17, 96, 250, 1024})
    for (const int lines : {1, 7, 8, 23, 300}) {
      std::vector<Count> counts(static_cast<std::size_t>(line_samples) *
                                static_cast<std::size_t>(lines));
      std::vector<std::uint64_t> sums(static_cast<std::size_t>(line_samples));
      for (std::size_t i = 0; i < counts.size(); ++i) {
        const auto p = i % sums.size();
        counts[i] =
            p % 3 == 0 ? std::numeric_limits<Count>::max() : static_cast<Count>(generator());
        sums[p] += static_cast<std::uint64_t>(counts[i] >> right_shift);
      }
      LineMean mean{line_samples};
      mean.measure(counts.data(), lines, right_shift);
      for (std::size_t p = 0; p < sums.size(); ++p)
        ASSERT_EQ(mean.values()[p], static_cast<double>(sums[p]) / lines)
            << line_samples << " samples, " << lines << " lines, at " << p;
    }
}

TEST(LineMean, of_counts_is_exact) {
  expect_exact_mean<std::uint8_t>(0);
  expect_exact_mean<std::uint16_t>(0);
  expect_exact_mean<std::uint16_t>(4);
}

class ResampledBackground : public testing::TestWithParam<Interpolation> {};

TEST_P(ResampledBackground, is_the_weighted_sum_rounded) {
  constexpr int line_samples = 1024;
  Calibration calibration = tests::chirped_calibration(line_samples, 70);
  calibration.interpolation = GetParam();
  std::mt19937 generator{31};
  std::uniform_real_distribution<float> counts{0, 65535};
  std::vector<float> background(line_samples);
  for (float& value : background)
    value = counts(generator);
  for (const WindowShape& shape : {WindowShape{16, 16, 32, false}, WindowShape{4, 4, 8, true}}) {
    const auto tables = make_fused_tables(calibration, 0, shape);
    ASSERT_TRUE(tables);
    std::vector<std::int32_t> found(line_samples);
    tables->resample_background(background.data(), 32768, found.data());
    const auto width = static_cast<std::size_t>(2 * tables->tap_pairs);
    for (std::size_t m = 0; m < line_samples; ++m) {
      double sum = 0;
      for (std::size_t t = 0; t < width; ++t)
        sum +=
            tables->tap_weights[m * width + t] *
            (static_cast<double>(background[static_cast<std::size_t>(tables->tap_starts[m]) + t]) -
             32768);
      ASSERT_EQ(found[static_cast<std::size_t>(tables->block_of[m])], std::lrint(sum)) << m;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Each, ResampledBackground,
                         testing::Values(Interpolation::linear, Interpolation::cubic,
                                         Interpolation::sinc8));

// With AVX-512's windows of 32 samples, also where the line is read to both ends.
TEST(FusedTables, hold_all_taps_of_a_block_in_one_window) {
  for (const auto interpolation : {Interpolation::cubic, Interpolation::sinc8}) {
    Calibration calibration = tests::chirped_calibration(1024, 70);
    calibration.interpolation = interpolation;
    const auto tables = make_fused_tables(calibration, 0, WindowShape{16, 16, 32, false});
    ASSERT_TRUE(tables);
    EXPECT_TRUE(tables->one_window);
  }
}

// What reconstructor_agreement_test.cpp has for windows of fewer taps.
TEST(FusedTables, need_more_windows_for_a_steep_curve) {
  for (const auto& [interpolation, pixels] :
       {std::pair{Interpolation::cubic, 250.0}, std::pair{Interpolation::sinc8, 200.0}}) {
    Calibration calibration = tests::chirped_calibration(1024, pixels);
    calibration.interpolation = interpolation;
    const auto tables = make_fused_tables(calibration, 0, WindowShape{16, 16, 32, false});
    ASSERT_TRUE(tables);
    EXPECT_FALSE(tables->one_window);
  }
}

} // namespace
} // namespace octascope::pipeline
