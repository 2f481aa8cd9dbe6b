// Fixed lines vanish; a horizontal reflector stays where the mean would take it.
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/files/calibrations.h"

namespace octascope::pipeline {
namespace {

constexpr int samples = 512;
constexpr int a_scans = 160;
constexpr int depths = samples / 2;
constexpr int line_depth = 40;      // of the fixed line, 100 times the reflector
constexpr int reflector_depth = 90; // in five of eight A-scans
constexpr int reflector_a_scans = a_scans * 5 / 8;
constexpr double reflector_amplitude = 200;
constexpr double roughness_rad = 0.3; // of the reflector, standard deviation of its phase

double fringe(int depth, int p, double phase) {
  return std::cos(2 * std::numbers::pi * depth * p / samples + phase);
}

// Light, a fixed line, a horizontal reflector over most of the B-scan, and noise.
std::vector<float> draw_b_scan() {
  std::mt19937 generator{31};
  std::normal_distribution<double> noise{0, 2};
  std::vector<float> counts;
  for (int a = 0; a < a_scans; ++a) {
    const double phase = 1.1 + roughness_rad / 2 * noise(generator);
    for (int p = 0; p < samples; ++p) {
      const double u = static_cast<double>(p) / samples;
      double count = 20000 * std::sin(std::numbers::pi * u) +
                     10 * reflector_amplitude * fringe(line_depth, p, 0.4);
      if (a < reflector_a_scans)
        count += reflector_amplitude * fringe(reflector_depth, p, phase);
      counts.push_back(static_cast<float>(count + noise(generator)));
    }
  }
  return counts;
}

std::vector<float> reconstruct(BackgroundMode mode, FixedPatternMode removal) {
  Calibration calibration = Calibration::identity(samples);
  calibration.background_mode = mode;
  calibration.fixed_pattern.mode = removal;
  if (mode == BackgroundMode::file)
    for (int p = 0; p < samples; ++p)
      calibration.background.push_back(
          static_cast<float>(19000 * std::sin(std::numbers::pi * p / samples))); // not quite
  const auto made =
      Reconstructor::create({calibration, SpectrumFormat{samples, hal::SampleType::f32}, a_scans});
  EXPECT_TRUE(made) << made.error().message;
  auto workspace = made->make_workspace();
  std::vector<float> db(made->levels());
  const auto counts = draw_b_scan();
  made->reconstruct_b_scan_db(workspace, std::as_bytes(std::span{counts}), db);
  return db;
}

// The level of the mean power at a depth over A-scans first … last−1.
double level_at(const std::vector<float>& db, int depth, int first, int last) {
  double power = 0;
  for (int a = first; a < last; ++a)
    power +=
        std::pow(10, static_cast<double>(db[static_cast<std::size_t>(a * depths + depth)]) / 10);
  return 10 * std::log10(power / (last - first));
}

TEST(FixedPattern, lines_vanish_whatever_the_background) {
  // Hann: half the amplitude of a fringe, a quarter of that for cos² → amplitude/4.
  const double line_db = 20 * std::log10(10 * reflector_amplitude / 4);
  const auto plain = reconstruct(BackgroundMode::none, FixedPatternMode::none);
  EXPECT_NEAR(level_at(plain, line_depth, 0, a_scans), line_db, 0.1);
  const double noise_db = level_at(plain, 200, 0, a_scans);
  for (const auto mode : {BackgroundMode::none, BackgroundMode::file, BackgroundMode::running,
                          BackgroundMode::mean}) {
    const auto db = reconstruct(mode, FixedPatternMode::minimum_variance);
    EXPECT_NEAR(level_at(db, line_depth, 0, a_scans), noise_db, 1.5);
    EXPECT_NEAR(level_at(db, 0, 0, a_scans), noise_db, 4); // real there: its power varies more
  }
}

TEST(FixedPattern, a_reflector_over_most_of_the_b_scan_survives_better_than_with_the_mean) {
  const double true_db = 20 * std::log10(reflector_amplitude / 4);
  const auto mean = reconstruct(BackgroundMode::mean, FixedPatternMode::none);
  const auto least = reconstruct(BackgroundMode::none, FixedPatternMode::minimum_variance);
  const double with_mean = level_at(mean, reflector_depth, 0, reflector_a_scans);
  const double with_least = level_at(least, reflector_depth, 0, reflector_a_scans);
  // What the mean leaves where the reflector is not: a ghost.
  const double ghost_mean = level_at(mean, reflector_depth, reflector_a_scans, a_scans);
  const double ghost_least = level_at(least, reflector_depth, reflector_a_scans, a_scans);
  fmt::print("  reflector of {:.1f} dB: {:.1f} with the mean (ghost {:.1f}), {:.1f} with the least "
             "variance (ghost {:.1f})\n",
             true_db, with_mean, ghost_mean, with_least, ghost_least);
  RecordProperty("reflector_db_lost_with_mean", fmt::format("{:.2f}", true_db - with_mean));
  RecordProperty("reflector_db_lost_with_least", fmt::format("{:.2f}", true_db - with_least));
  // The mean of exp(iφ) is c = exp(−σ²/2). The mean over the B-scan takes 5/8·c of the reflector,
  // which leaves 1 − 2·taken·c + taken² of its power, and puts taken² where there was nothing.
  const double c = std::exp(-roughness_rad * roughness_rad / 2);
  const double taken = 5.0 / 8 * c;
  const double left = 1 - 2 * taken * c + taken * taken;
  EXPECT_NEAR(with_mean, true_db + 10 * std::log10(left), 0.5);
  EXPECT_NEAR(ghost_mean, true_db + 20 * std::log10(5.0 / 8 * c), 0.5);
  EXPECT_NEAR(with_least, true_db, 0.5);
  EXPECT_LT(ghost_least, ghost_mean - 10);
}

TEST(FixedPattern, takes_the_mean_of_the_quietest_segment) {
  // Against the plain recipe in double precision, with fixed values far above what varies.
  constexpr int few = 9;
  FixedPatternRemover remover{4, 21, few};
  std::mt19937 generator{5};
  std::normal_distribution<float> normal{0, 1};
  std::vector<std::vector<std::complex<double>>> values(few);
  for (int a = 0; a < 21; ++a) {
    const float loudness = a < 5 ? 3 : a < 10 ? 0.5F : a < 15 ? 2 : 1; // segments 0 … 3
    for (std::size_t z = 0; z < few; ++z) {
      remover.a_scan(a)[2 * z] = 1e4F + loudness * normal(generator);
      remover.a_scan(a)[2 * z + 1] = -3e4F + loudness * normal(generator);
      values[z].emplace_back(remover.a_scan(a)[2 * z], remover.a_scan(a)[2 * z + 1]);
    }
  }
  remover.remove(21);
  for (std::size_t z = 0; z < few; ++z) {
    std::complex<double> pattern;
    double least = 1e300;
    for (int s = 0; s < 4; ++s) {
      const int first = 21 * s / 4;
      const int last = 21 * (s + 1) / 4;
      std::complex<double> mean;
      for (int a = first; a < last; ++a)
        mean += values[z][static_cast<std::size_t>(a)] / static_cast<double>(last - first);
      double variance = 0;
      for (int a = first; a < last; ++a)
        variance += std::norm(values[z][static_cast<std::size_t>(a)] - mean) / (last - first);
      if (variance < least) {
        least = variance;
        pattern = mean;
      }
    }
    for (int a = 0; a < 21; ++a) {
      const auto expected = values[z][static_cast<std::size_t>(a)] - pattern;
      EXPECT_NEAR(static_cast<double>(remover.a_scan(a)[2 * z]), expected.real(), 0.01);
      EXPECT_NEAR(static_cast<double>(remover.a_scan(a)[2 * z + 1]), expected.imag(), 0.01);
    }
  }
}

TEST(FixedPattern, allocates_nothing) {
  Calibration calibration = Calibration::identity(samples);
  calibration.fixed_pattern.mode = FixedPatternMode::minimum_variance;
  const auto made =
      Reconstructor::create({calibration, SpectrumFormat{samples, hal::SampleType::f32}, a_scans});
  ASSERT_TRUE(made);
  EXPECT_EQ(made->path(), ReconstructionPath::fftw);
  auto workspace = made->make_workspace();
  const auto counts = draw_b_scan();
  std::vector<std::uint8_t> levels(made->levels());
  const auto before = tests::allocations_of_this_thread();
  ASSERT_GT(before, 0U);
  made->reconstruct_b_scan(workspace, std::as_bytes(std::span{counts}), levels);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
}

TEST(FixedPattern, refuses_too_few_a_scans) {
  Calibration calibration = Calibration::identity(64);
  calibration.fixed_pattern.mode = FixedPatternMode::minimum_variance;
  const auto message = [&](int lines) {
    const auto made =
        Reconstructor::create({calibration, SpectrumFormat{64, hal::SampleType::u16}, lines});
    return made ? std::string{} : made.error().message;
  };
  EXPECT_EQ(message(32), "");
  EXPECT_EQ(message(31), "fixed_pattern: 8 segments of 31 A-scans, expected at least 4 A-scans a "
                         "segment: fewer segments, or mode = \"none\"");
  calibration.fixed_pattern.segments = 1;
  EXPECT_EQ(message(31), "fixed_pattern: segments is 1, expected 2 to 64");
}

} // namespace
} // namespace octascope::pipeline
