// Closed forms: reflectors, Parseval, linearity, shift; and what the interface promises.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/volume/level_scale.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/files/calibrations.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// One B-scan of float lines in decibels.
std::vector<float> reconstruct_db(const Calibration& calibration, const std::vector<float>& lines) {
  const auto a_scans = static_cast<int>(lines.size()) / calibration.samples;
  const auto reconstructor = Reconstructor::create(
      {calibration, SpectrumFormat{calibration.samples, hal::SampleType::f32}, a_scans});
  EXPECT_TRUE(reconstructor) << reconstructor.error().message;
  auto workspace = reconstructor->make_workspace();
  std::vector<float> db(reconstructor->levels());
  reconstructor->reconstruct_b_scan_db(workspace, std::as_bytes(std::span{lines}), db);
  return db;
}

// m for each pixel p: the inverse of r(m) of chirped_calibration(), in closed form.
double sample_at_pixel(int samples, double chirp, double p) {
  if (chirp == 0)
    return p;
  const double c = 4 * chirp; // p = (n + c)·u − c·u², n = samples − 1
  const double b = samples - 1 + c;
  return (samples - 1) * (b - std::sqrt(b * b - 4 * c * p)) / (2 * c);
}

double theta_at(double u, double d2, double d3) {
  const double v = u - 0.5;
  return d2 * v * v + d3 * v * v * v;
}

// |Σ w[m]·exp(2πi·x·m/N)|/N: what the window makes of a reflector x bins away.
double window_response(const std::vector<double>& window, double x) {
  std::complex<double> sum = 0;
  const auto n = static_cast<double>(window.size());
  for (std::size_t m = 0; m < window.size(); ++m)
    sum += window[m] * std::polar(1.0, two_pi * x * static_cast<double>(m) / n);
  return std::abs(sum) / n;
}

struct Reflector {
  double depth;
  double chirp;
  double d2;
  double d3;
  Interpolation interpolation;
};

class ReflectorOracle : public testing::TestWithParam<Reflector> {};

TEST_P(ReflectorOracle, is_where_and_as_bright_as_it_should_be) {
  constexpr int samples = 1024;
  constexpr double amplitude = 3000;
  const Reflector& r = GetParam();
  Calibration calibration = tests::chirped_calibration(samples, r.chirp);
  calibration.interpolation = r.interpolation;
  calibration.background_mode = BackgroundMode::none;
  if (r.d2 != 0 || r.d3 != 0)
    calibration.dispersion_rad = tests::dispersion(samples, r.d2, r.d3);

  std::vector<float> line(samples);
  for (int p = 0; p < samples; ++p) {
    const double m = sample_at_pixel(samples, r.chirp, p);
    line[static_cast<std::size_t>(p)] =
        static_cast<float>(amplitude * std::cos(two_pi * r.depth * m / samples -
                                                theta_at(m / (samples - 1), r.d2, r.d3) + 0.7));
  }
  const auto db = reconstruct_db(calibration, line);

  const auto peak = std::max_element(db.begin() + 5, db.end());
  const auto k = static_cast<double>(peak - db.begin());
  // Hann: the ratio of two neighbouring bins gives the position between them exactly.
  const bool right = *(peak + 1) > *(peak - 1);
  const double ratio =
      std::pow(10.0, static_cast<double>((right ? *(peak + 1) : *(peak - 1)) - *peak) / 20);
  const double offset = (2 * ratio - 1) / (1 + ratio) * (right ? 1 : -1);
  EXPECT_NEAR(k + offset, r.depth, 0.1);
  const double expected =
      20 * std::log10(amplitude / 2 * window_response(calibration.window, r.depth - k));
  EXPECT_NEAR(static_cast<double>(*peak), expected, 0.1);
}

INSTANTIATE_TEST_SUITE_P(depths, ReflectorOracle,
                         testing::Values(Reflector{40, 0, 0, 0, Interpolation::sinc8},
                                         Reflector{100.3, 0, 60, -30, Interpolation::sinc8},
                                         Reflector{20.4, 70, 0, 0, Interpolation::sinc8},
                                         Reflector{60.5, 70, 60, -30, Interpolation::sinc8},
                                         Reflector{150, 70, -80, 40, Interpolation::sinc8},
                                         Reflector{230.7, 70, 60, -30, Interpolation::sinc8},
                                         Reflector{60.5, 70, 60, -30, Interpolation::cubic},
                                         Reflector{120.2, -50, 60, -30, Interpolation::cubic},
                                         Reflector{25.5, 70, 60, -30, Interpolation::linear}));

TEST(Reconstructor, keeps_the_energy) {
  // Parseval, for a line with nothing in its topmost bin, which is not delivered.
  constexpr int samples = 256;
  Calibration calibration = Calibration::identity(samples);
  calibration.background_mode = BackgroundMode::none;
  calibration.window = make_spectral_window(SpectralWindow::flat, samples);
  std::mt19937 generator{7};
  std::normal_distribution<double> normal{0, 50};
  std::vector<double> exact(samples);
  for (int bin = 1; bin < samples / 2; ++bin) {
    const double a = normal(generator);
    const double b = normal(generator);
    for (int m = 0; m < samples; ++m)
      exact[static_cast<std::size_t>(m)] +=
          a * std::cos(two_pi * bin * m / samples) + b * std::sin(two_pi * bin * m / samples);
  }
  const std::vector<float> line(exact.begin(), exact.end());
  const auto db = reconstruct_db(calibration, line);
  double in_bins = 0;
  for (const float level : db)
    in_bins += 2 * std::pow(10.0, static_cast<double>(level) / 10);
  const double in_samples =
      std::inner_product(exact.begin(), exact.end(), exact.begin(), 0.0) / samples;
  EXPECT_NEAR(in_bins / in_samples, 1.0, 1e-3);
}

std::vector<float> noise(int size, unsigned seed) {
  std::mt19937 generator{seed};
  std::uniform_real_distribution<float> values{0.0F, 4095.0F};
  std::vector<float> line(static_cast<std::size_t>(size));
  std::generate(line.begin(), line.end(), [&] { return values(generator); });
  return line;
}

TEST(Reconstructor, is_linear) {
  Calibration calibration = tests::chirped_calibration(1000, 60);
  calibration.dispersion_rad = tests::dispersion(1000, 40, 10);
  auto lines = noise(5000, 3);
  const auto once = reconstruct_db(calibration, lines);
  for (float& value : lines)
    value = 10 * value + 77; // the mean takes what is added
  const auto tenfold = reconstruct_db(calibration, lines);
  for (std::size_t i = 0; i < once.size(); ++i)
    ASSERT_NEAR(tenfold[i] - once[i], 20.0F, 0.02F) << i;
}

TEST(Reconstructor, a_linear_phase_shifts_the_depth) {
  constexpr int samples = 500;
  constexpr int shift = 5;
  Calibration calibration = tests::chirped_calibration(samples, 30);
  calibration.dispersion_rad = tests::dispersion(samples, 40, 10);
  const auto lines = noise(3 * samples, 4);
  const auto straight = reconstruct_db(calibration, lines);
  for (std::size_t m = 0; m < samples; ++m)
    calibration.dispersion_rad[m] += two_pi * shift * static_cast<double>(m) / samples;
  const auto shifted = reconstruct_db(calibration, lines);
  constexpr std::size_t depths = samples / 2;
  for (std::size_t i = 0; i + shift < straight.size(); ++i) {
    if (i % depths + shift < depths) {
      ASSERT_NEAR(shifted[i + shift], straight[i], 0.02F) << i;
    }
  }
}

TEST(Reconstructor, never_reads_the_neighbouring_line) {
  constexpr int samples = 129;
  for (const auto interpolation :
       {Interpolation::linear, Interpolation::cubic, Interpolation::sinc8}) {
    Calibration calibration = tests::chirped_calibration(samples, 9);
    calibration.interpolation = interpolation;
    calibration.background_mode = BackgroundMode::none;
    calibration.window = make_spectral_window(SpectralWindow::flat, samples); // edges count fully
    const auto line = noise(samples, 5);
    const auto alone = reconstruct_db(calibration, line);
    std::vector<float> poisoned(3 * samples, std::numeric_limits<float>::quiet_NaN());
    std::ranges::copy(line, poisoned.begin() + samples);
    const auto between = reconstruct_db(calibration, poisoned);
    for (std::size_t z = 0; z < alone.size(); ++z)
      ASSERT_EQ(alone[z], between[alone.size() + z]) << z;
  }
}

TEST(Reconstructor, reads_only_the_kept_lines) {
  constexpr int samples = 64;
  const Calibration calibration = Calibration::identity(samples);
  hal::LineFormat camera;
  camera.samples_per_line = samples;
  camera.lines_per_frame = 5;
  const auto reconstructor =
      tests::must(Reconstructor::create({calibration, SpectrumFormat{camera}, 3}));
  std::mt19937 generator{1};
  std::vector<std::uint16_t> frame(5 * samples);
  for (auto& count : frame)
    count = static_cast<std::uint16_t>(generator() % 4000);
  auto workspace = reconstructor.make_workspace();
  std::vector<std::uint8_t> levels(reconstructor.levels());
  std::vector<std::uint8_t> again(reconstructor.levels());
  const auto outcome =
      reconstructor.reconstruct_b_scan(workspace, std::as_bytes(std::span{frame}), levels);
  EXPECT_EQ(outcome.saturated_lines, 0);
  std::fill(frame.begin() + 3 * samples, frame.end(), std::uint16_t{4095});
  const auto with_fly_back =
      reconstructor.reconstruct_b_scan(workspace, std::as_bytes(std::span{frame}), again);
  EXPECT_EQ(with_fly_back.saturated_lines, 0);
  EXPECT_EQ(levels, again);
}

TEST(Reconstructor, counts_saturated_lines) {
  constexpr int samples = 50;
  SpectrumFormat format{samples, hal::SampleType::u16};
  format.significant_bits = 12;
  format.right_shift = 4;
  const auto reconstructor =
      tests::must(Reconstructor::create({Calibration::identity(samples), format, 4}));
  std::vector<std::uint16_t> frame(4 * samples, 4094 << 4);
  frame[samples - 1] = 4095 << 4;
  frame[2 * samples] = 4095 << 4;
  frame[2 * samples + 1] = 4095 << 4;
  auto workspace = reconstructor.make_workspace();
  std::vector<std::uint8_t> levels(reconstructor.levels());
  EXPECT_EQ(reconstructor.reconstruct_b_scan(workspace, std::as_bytes(std::span{frame}), levels)
                .saturated_lines,
            2);
}

TEST(Reconstructor, a_dark_line_is_dark) {
  const auto reconstructor = tests::must(Reconstructor::create(
      {Calibration::identity(64), SpectrumFormat{64, hal::SampleType::u8}, 2}));
  auto workspace = reconstructor.make_workspace();
  const std::vector<std::byte> frame(128);
  std::vector<std::uint8_t> levels(reconstructor.levels(), 9);
  reconstructor.reconstruct_b_scan(workspace, frame, levels);
  EXPECT_EQ(levels, std::vector<std::uint8_t>(levels.size(), 0));
}

TEST(Reconstructor, a_running_background_remembers) {
  // Constant B-scans of 100 and then 200 counts: the mean takes all of each, the running mean
  // leaves half of the step in the second: DC of 50 counts.
  constexpr int samples = 32;
  Calibration calibration = Calibration::identity(samples);
  calibration.background_mode = BackgroundMode::running;
  calibration.window = make_spectral_window(SpectralWindow::flat, samples);
  const auto reconstructor = tests::must(
      Reconstructor::create({calibration, SpectrumFormat{samples, hal::SampleType::u8}, 2}));
  auto workspace = reconstructor.make_workspace();
  std::vector<float> db(reconstructor.levels());
  const std::vector<std::byte> first(2 * samples, std::byte{100});
  const std::vector<std::byte> second(2 * samples, std::byte{200});
  reconstructor.reconstruct_b_scan_db(workspace, first, db);
  EXPECT_LT(db[0], -100);
  reconstructor.reconstruct_b_scan_db(workspace, second, db);
  EXPECT_NEAR(db[0], 20 * std::log10(50.0), 0.01);
  workspace.reset_background();
  reconstructor.reconstruct_b_scan_db(workspace, second, db);
  EXPECT_LT(db[0], -100);
}

TEST(Reconstructor, serves_many_threads) {
  Calibration calibration = tests::chirped_calibration(256, 15);
  calibration.dispersion_rad = tests::dispersion(256, 40, 10);
  const auto lines = noise(256 * 20, 6);
  const auto expected = reconstruct_db(calibration, lines);
  const auto reconstructor = tests::must(
      Reconstructor::create({calibration, SpectrumFormat{256, hal::SampleType::f32}, 20}));
  std::vector<std::vector<float>> results(4, std::vector<float>(reconstructor.levels()));
  {
    std::vector<std::jthread> threads;
    for (auto& result : results)
      threads.emplace_back([&] {
        auto workspace = reconstructor.make_workspace();
        for (int i = 0; i < 10; ++i)
          reconstructor.reconstruct_b_scan_db(workspace, std::as_bytes(std::span{lines}), result);
        // Making another one meanwhile disturbs nobody.
        EXPECT_TRUE(Reconstructor::create(
            {Calibration::identity(100), SpectrumFormat{100, hal::SampleType::u16}, 1}));
      });
  }
  for (const auto& result : results) {
    for (std::size_t i = 0; i < result.size(); ++i)
      ASSERT_NEAR(result[i], expected[i], 0.02F);
  }
}

TEST(Reconstructor, allocates_nothing) {
  for (const auto mode : {BackgroundMode::mean, BackgroundMode::running}) {
    for (const bool dispersed : {false, true}) {
      Calibration calibration = tests::chirped_calibration(1024, 70);
      calibration.background_mode = mode;
      if (dispersed)
        calibration.dispersion_rad = tests::dispersion(1024, 40, 10);
      const auto reconstructor = tests::must(
          Reconstructor::create({calibration, SpectrumFormat{1024, hal::SampleType::u16}, 20}));
      auto workspace = reconstructor.make_workspace();
      const std::vector<std::uint16_t> frame(20 * 1024, 777);
      std::vector<std::uint8_t> levels(reconstructor.levels());
      std::vector<float> db(reconstructor.levels());
      const auto before = tests::allocations_of_this_thread();
      ASSERT_GT(before, 0U);
      reconstructor.reconstruct_b_scan(workspace, std::as_bytes(std::span{frame}), levels);
      reconstructor.reconstruct_b_scan_db(workspace, std::as_bytes(std::span{frame}), db);
      EXPECT_EQ(tests::allocations_of_this_thread(), before);
    }
  }
}

TEST(Reconstructor, refuses_what_does_not_fit_together) {
  const auto message = [](const ReconstructionSetup& setup) {
    return tests::error_of(Reconstructor::create(setup)).message;
  };
  const Calibration good = Calibration::identity(64);
  const SpectrumFormat u16{64, hal::SampleType::u16};
  EXPECT_EQ(message({good, SpectrumFormat{65, hal::SampleType::u16}, 1}),
            "reconstruction: lines have 65 samples, the calibration is for 64");
  EXPECT_EQ(message({good, u16, 0}), "reconstruction: a_scans is 0, expected 1 to 65536");
  SpectrumFormat shifted = u16;
  shifted.right_shift = 4;
  EXPECT_EQ(message({good, shifted, 1}),
            "reconstruction: significant_bits 16 and right_shift 4 do not fit into 16 bits");
  Calibration bad = good;
  bad.positions[3] = 64;
  EXPECT_EQ(message({bad, u16, 1}), "calibration: position 3 is 64, expected 0 to 63");
  bad = good;
  bad.dispersion_rad.assign(64, std::nan(""));
  EXPECT_EQ(message({bad, u16, 1}), "calibration: phase 0 is nan, expected a finite number");
  bad = good;
  bad.window.pop_back();
  EXPECT_EQ(message({bad, u16, 1}), "calibration: window has 63 values, expected 64");
  EXPECT_NE(message({Calibration::identity(15), SpectrumFormat{15, hal::SampleType::u16}, 1}), "");
}

} // namespace
} // namespace octascope::pipeline
