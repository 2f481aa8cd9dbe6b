// The fast path against the independent reference: within one count of 255 everywhere.
#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/files/calibrations.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"
#include "tests/support/spectra/reference_chain.h"

namespace octascope::pipeline {
namespace {

using tests::chirped_calibration;

// Counts and decibels of one B-scan against the reference; prints the share that differs.
template <class Count>
void expect_agreement(const Reconstructor& reconstructor, const std::vector<Count>& raw,
                      const std::vector<std::complex<double>>& reference_bins) {
  const std::vector<double> reference = tests::reference_levels_db(reference_bins);
  auto workspace = reconstructor.make_workspace();
  std::vector<std::uint8_t> counts(reconstructor.levels());
  std::vector<float> db(reconstructor.levels());
  reconstructor.reconstruct_b_scan(workspace, std::as_bytes(std::span{raw}), counts);
  reconstructor.reconstruct_b_scan_db(workspace, std::as_bytes(std::span{raw}), db);
  ASSERT_EQ(reference.size(), counts.size());
  std::vector<std::uint8_t> counts_of_bins(reconstructor.levels());
  std::vector<PackedBin> bins(reconstructor.levels());
  reconstructor.reconstruct_b_scan_both(workspace, std::as_bytes(std::span{raw}), bins,
                                        counts_of_bins);
  EXPECT_EQ(counts_of_bins, counts);
  const bool fused = reconstructor.path() == ReconstructionPath::fused;
  const double fixed_point_floor = fused ? 2e-4 : 0; // of the root mean square: weights are Q14
  double power = 0;
  for (const double value : reference)
    power += std::pow(10, value / 10);
  const double level = std::sqrt(power / static_cast<double>(reference.size()));
  // Counts less their background are rounded to floats; so is each pass of the transform.
  const double highest = std::abs(static_cast<double>(*std::ranges::max_element(raw)));
  const double rounding =
      highest * std::pow(2, -24) / std::sqrt(static_cast<double>(reconstructor.samples()));
  const double farthest = (fused ? 2.5e-4 : 1e-5) * level + rounding;
  for (std::size_t i = 0; i < bins.size(); ++i)
    ASSERT_LE(std::abs(std::complex<double>{bins[i].value()} - reference_bins[i]),
              farthest + PackedBin::most_error * (std::abs(reference_bins[i]) + farthest))
        << "bin " << i << ", " << reconstructor.isa();
  std::size_t different = 0;
  int largest = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const int difference = std::abs(tests::reference_count(reference[i]) - counts[i]);
    different += difference != 0 ? 1 : 0;
    largest = std::max(largest, difference);
    // Far below the display's range float rounding of the transform takes over.
    if (reference[i] > -20) {
      const double floor = fixed_point_floor * level / std::pow(10, reference[i] / 20);
      ASSERT_NEAR(static_cast<double>(db[i]), reference[i], 0.05 + 20 * std::log10(1 + floor))
          << "voxel " << i << ", " << reconstructor.isa();
    }
  }
  EXPECT_LE(largest, 1) << reconstructor.isa();
  fmt::print("  {} {}: {} of {} counts differ ({:.3f} %), by at most {}\n",
             fused ? "fused" : "fftw", reconstructor.isa(), different, counts.size(),
             100.0 * static_cast<double>(different) / static_cast<double>(counts.size()), largest);
}

// Both paths, the fused one with every instruction set of this processor.
template <class Count>
void expect_agreement(const Calibration& calibration, hal::SampleType type,
                      const std::vector<Count>& raw, int lines, int right_shift = 0) {
  SpectrumFormat format{calibration.samples, type};
  format.right_shift = right_shift;
  format.significant_bits -= right_shift;
  std::vector<double> shifted;
  for (const Count count : raw) {
    if constexpr (std::is_same_v<Count, float>)
      shifted.push_back(static_cast<double>(count));
    else
      shifted.push_back(count >> right_shift);
  }
  const auto reference = tests::reference_b_scan_bins(shifted, lines, calibration);
  const auto fftw = Reconstructor::create({calibration, format, lines, ReconstructionPath::fftw});
  ASSERT_TRUE(fftw) << fftw.error().message;
  ASSERT_EQ(fftw->path(), ReconstructionPath::fftw);
  expect_agreement(*fftw, raw, reference);
  const bool covered = !std::is_same_v<Count, float> && calibration.samples >= 256 &&
                       std::has_single_bit(static_cast<unsigned>(calibration.samples));
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const std::string isa = hwy::TargetName(target);
    const auto fused =
        Reconstructor::create({calibration, format, lines, ReconstructionPath::fused, isa});
    ASSERT_TRUE(fused) << fused.error().message;
    if (fused->path() == ReconstructionPath::fused) {
      EXPECT_TRUE(covered);
      EXPECT_EQ(fused->isa(), isa);
      expect_agreement(*fused, raw, reference);
    } else {
      const bool has_kernels = (isa == "AVX3" && calibration.samples >= 512) || isa == "AVX2" ||
                               isa == "SSE4" || isa == "NEON";
      EXPECT_FALSE(covered && has_kernels) << isa;
    }
  }
}

template <class Count> std::vector<Count> random_counts(std::size_t size, unsigned seed) {
  std::mt19937 generator{seed};
  std::vector<Count> counts(size);
  if constexpr (std::is_same_v<Count, float>) {
    std::uniform_real_distribution<float> values{-2000.0F, 9000.0F};
    for (Count& count : counts)
      count = values(generator);
  } else {
    std::uniform_int_distribution<int> values{0, std::numeric_limits<Count>::max()};
    for (Count& count : counts)
      count = static_cast<Count>(values(generator));
  }
  return counts;
}

struct Case {
  int samples;
  Interpolation interpolation;
  SpectralWindow window;
  bool dispersed;
  BackgroundMode background;
  double chirp_pixels;
};

std::string name(const testing::TestParamInfo<Case>& info) {
  const Case& c = info.param;
  return fmt::format("n{}_i{}_w{}_{}_b{}_c{}", c.samples, static_cast<int>(c.interpolation),
                     static_cast<int>(c.window), c.dispersed ? "dispersed" : "plain",
                     static_cast<int>(c.background), static_cast<int>(std::abs(c.chirp_pixels)));
}

class Agreement : public testing::TestWithParam<Case> {
protected:
  static constexpr int lines = 9;

  static Calibration calibration() {
    const Case& c = GetParam();
    Calibration calibration = chirped_calibration(c.samples, c.chirp_pixels);
    calibration.interpolation = c.interpolation;
    calibration.window = make_spectral_window(c.window, c.samples);
    calibration.background_mode = c.background;
    if (c.background == BackgroundMode::file)
      calibration.background = random_counts<float>(static_cast<std::size_t>(c.samples), 5);
    if (c.dispersed)
      calibration.dispersion_rad = tests::dispersion(c.samples, 40, -25);
    return calibration;
  }
  static std::size_t size() { return static_cast<std::size_t>(GetParam().samples) * lines; }
};

TEST_P(Agreement, u8) {
  expect_agreement(calibration(), hal::SampleType::u8, random_counts<std::uint8_t>(size(), 1),
                   lines);
}
TEST_P(Agreement, u16) {
  expect_agreement(calibration(), hal::SampleType::u16, random_counts<std::uint16_t>(size(), 2),
                   lines);
}
TEST_P(Agreement, u16_left_justified) {
  expect_agreement(calibration(), hal::SampleType::u16, random_counts<std::uint16_t>(size(), 3),
                   lines, 4);
}
TEST_P(Agreement, f32) {
  expect_agreement(calibration(), hal::SampleType::f32, random_counts<float>(size(), 4), lines);
}

constexpr auto sinc8 = Interpolation::sinc8;
constexpr auto hann = SpectralWindow::hann;
constexpr auto mean = BackgroundMode::mean;

INSTANTIATE_TEST_SUITE_P(
    lengths, Agreement,
    testing::Values(
        Case{1024, sinc8, hann, true, mean, 70}, Case{1024, sinc8, hann, false, mean, 70},
        Case{2048, sinc8, hann, true, mean, 140}, Case{256, sinc8, hann, true, mean, 15},
        Case{256, Interpolation::linear, hann, false, mean, 15},
        Case{512, sinc8, hann, true, mean, -30}, Case{4096, sinc8, hann, true, mean, 200},
        Case{8192, Interpolation::cubic, hann, true, mean, 400},
        Case{1000, sinc8, hann, true, mean, 60}, Case{1000, sinc8, hann, false, mean, 60},
        Case{257, sinc8, hann, true, mean, 15}, Case{257, sinc8, hann, false, mean, 15},
        Case{16, sinc8, hann, true, mean, 1}, Case{16, Interpolation::cubic, hann, false, mean, 1},
        Case{17, Interpolation::linear, hann, true, mean, 1},
        Case{1021, sinc8, hann, true, mean, 60}, Case{1024, sinc8, hann, true, mean, 0},
        Case{1024, sinc8, hann, false, mean, 0}),
    name);
INSTANTIATE_TEST_SUITE_P(
    interpolations, Agreement,
    testing::Values(Case{1024, sinc8, hann, true, mean, 200},                // one window does not
                    Case{1024, Interpolation::cubic, hann, true, mean, 250}, // hold these
                    Case{1024, Interpolation::linear, hann, true, mean, 70},
                    Case{1024, Interpolation::linear, hann, false, mean, 70},
                    Case{1024, Interpolation::cubic, hann, true, mean, 70},
                    Case{1024, Interpolation::cubic, hann, false, mean, 70}),
    name);
INSTANTIATE_TEST_SUITE_P(windows_and_backgrounds, Agreement,
                         testing::Values(Case{512, sinc8, SpectralWindow::hamming, true, mean, 30},
                                         Case{512, sinc8, SpectralWindow::blackman, true, mean, 30},
                                         Case{512, sinc8, SpectralWindow::gaussian, false, mean,
                                              30},
                                         Case{512, sinc8, SpectralWindow::tukey, true, mean, 30},
                                         Case{512, sinc8, SpectralWindow::flat, true, mean, 30},
                                         Case{512, sinc8, hann, true, BackgroundMode::none, 30},
                                         Case{512, sinc8, hann, false, BackgroundMode::file, 30},
                                         Case{512, sinc8, hann, true, BackgroundMode::running, 30}),
                         name);

TEST(ReconstructorRealData, agrees_with_the_reference) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/spectra_u16_100x100x1024.raw");
  const auto calibration = Calibration::load(tests::TissueCalibration{}.file(), 1024);
  ASSERT_TRUE(calibration) << calibration.error().message;
  std::ifstream in{tests::test_data_folder() / "sd-oct-tissue/spectra_u16_100x100x1024.raw",
                   std::ios::binary};
  for (const int b : {0, 50, 99}) {
    std::vector<std::uint16_t> raw(100 * 1024);
    in.seekg(b * 100 * 1024 * 2);
    in.read(reinterpret_cast<char*>(raw.data()), 100 * 1024 * 2);
    ASSERT_TRUE(in);
    for (const auto interpolation :
         {Interpolation::linear, Interpolation::cubic, Interpolation::sinc8}) {
      Calibration variant = *calibration;
      variant.interpolation = interpolation;
      expect_agreement(variant, hal::SampleType::u16, raw, 100);
    }
  }
}

} // namespace
} // namespace octascope::pipeline
