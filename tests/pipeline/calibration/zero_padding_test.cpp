// Zero-padding: twice the depths, half their distance, the same levels.
#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/scan/scan_plan.h"
#include "tests/support/files/calibrations.h"
#include "tests/support/must.h"
#include "tests/support/spectra/reference_chain.h"

namespace octascope::pipeline {
namespace {

constexpr int lines = 5;

std::vector<std::uint16_t> draw_counts(int samples) {
  std::mt19937 generator{17};
  std::vector<std::uint16_t> counts(static_cast<std::size_t>(samples) * lines);
  std::ranges::generate(counts, [&] { return static_cast<std::uint16_t>(generator() % 4096); });
  return counts;
}

std::vector<float> reconstruct(const Calibration& calibration,
                               const std::vector<std::uint16_t>& counts) {
  const auto made = Reconstructor::create(
      {calibration, SpectrumFormat{calibration.samples, hal::SampleType::u16}, lines});
  EXPECT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->depths(), calibration.depths());
  auto workspace = made->make_workspace();
  std::vector<float> db(made->levels());
  for (int repeat = 0; repeat < 2; ++repeat) // what a first B-scan leaves behind must not show
    made->reconstruct_b_scan_db(workspace, std::as_bytes(std::span{counts}), db);
  return db;
}

class ZeroPadding : public testing::TestWithParam<int> {};

TEST_P(ZeroPadding, agrees_with_the_reference) {
  const int samples = GetParam();
  for (const bool dispersed : {false, true}) {
    Calibration calibration = tests::chirped_calibration(samples, samples / 20.0);
    calibration.zero_padding = 2;
    if (dispersed)
      calibration.dispersion_rad = tests::dispersion(samples, 30, -20);
    const auto counts = draw_counts(samples);
    const auto db = reconstruct(calibration, counts);
    const auto expected = tests::reference_b_scan_db(
        std::vector<double>{counts.begin(), counts.end()}, lines, calibration);
    ASSERT_EQ(db.size(), expected.size());
    ASSERT_EQ(db.size(), static_cast<std::size_t>(samples) * lines);
    for (std::size_t i = 0; i < db.size(); ++i) {
      if (expected[i] > -15) {
        ASSERT_NEAR(static_cast<double>(db[i]), expected[i], 0.02) << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(lengths, ZeroPadding, testing::Values(16, 17, 509, 1000, 1024));

TEST(ZeroPadding, the_geometry_follows) {
  ScanPlan plan;
  const VolumeGeometry plain = plan.geometry();
  plan.zero_padding = 2;
  const VolumeGeometry padded = plan.geometry();
  EXPECT_EQ(padded.depths, 1024);
  EXPECT_DOUBLE_EQ(padded.depth_spacing_um, 1.75);
  EXPECT_DOUBLE_EQ(padded.depth_mm(), plain.depth_mm());
  EXPECT_EQ(padded.a_scans, plain.a_scans);
  Calibration calibration = Calibration::identity(17);
  calibration.zero_padding = 2;
  EXPECT_EQ(calibration.depths(), 17);
  EXPECT_DOUBLE_EQ(calibration.bin_spacing_um(), calibration.depth_spacing_um / 2);
}

TEST_P(ZeroPadding, every_second_level_is_one_without_it) {
  const int samples = GetParam();
  Calibration calibration = tests::chirped_calibration(samples, samples / 20.0);
  const auto counts = draw_counts(samples);
  const auto plain = reconstruct(calibration, counts);
  calibration.zero_padding = 2;
  const auto padded = reconstruct(calibration, counts);
  const auto depths = static_cast<std::size_t>(samples / 2);
  for (std::size_t a = 0; a < lines; ++a) {
    for (std::size_t z = 0; z < depths; ++z) {
      const float level = plain[a * depths + z];
      if (level > 0) {
        ASSERT_NEAR(padded[a * static_cast<std::size_t>(samples) + 2 * z], level, 0.02F);
      }
    }
  }
}

TEST(ZeroPadding, is_the_fftw_paths_business) {
  Calibration calibration = Calibration::identity(256);
  calibration.zero_padding = 2;
  const auto made = Reconstructor::create(
      {calibration, SpectrumFormat{256, hal::SampleType::u16}, 3, ReconstructionPath::fused});
  ASSERT_TRUE(made);
  EXPECT_EQ(made->path(), ReconstructionPath::fftw);
  EXPECT_EQ(made->path_decision().reason, PathReason::only);
  calibration.zero_padding = 3;
  EXPECT_EQ(tests::error_of(
                Reconstructor::create({calibration, SpectrumFormat{256, hal::SampleType::u16}, 3}))
                .message,
            "calibration: zero_padding is 3, expected 1 (none) or 2");
}

} // namespace
} // namespace octascope::pipeline
