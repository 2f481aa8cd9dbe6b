// What the interface promises. Closed forms: calibration/depth_oracle_test.cpp; the reference:
// input_types_test.cpp.
#include <algorithm>
#include <limits>
#include <random>
#include <span>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/files/calibrations.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

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

std::vector<float> noise(int size, unsigned seed) {
  std::mt19937 generator{seed};
  std::uniform_real_distribution<float> values{0.0F, 4095.0F};
  std::vector<float> line(static_cast<std::size_t>(size));
  std::generate(line.begin(), line.end(), [&] { return values(generator); });
  return line;
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
      std::vector<PackedBin> bins(reconstructor.levels());
      const auto before = tests::allocations_of_this_thread();
      ASSERT_GT(before, 0U);
      reconstructor.reconstruct_b_scan(workspace, std::as_bytes(std::span{frame}), levels);
      reconstructor.reconstruct_b_scan_db(workspace, std::as_bytes(std::span{frame}), db);
      reconstructor.reconstruct_b_scan_both(workspace, std::as_bytes(std::span{frame}), bins,
                                            levels);
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

TEST(Reconstructor, a_running_background_remembers) {
  // Constant B-scans of 100 and then 200 counts: the mean takes all of each, the running mean
  // leaves half of the step in the second: DC of 50 counts.
  constexpr int samples = 32;
  Calibration calibration = Calibration::identity(samples);
  calibration.background_mode = BackgroundMode::running;
  calibration.window = make_spectral_window(SpectralWindow::flat, samples);
  const auto reconstructor =
      Reconstructor::create({calibration, SpectrumFormat{samples, hal::SampleType::u8}, 2});
  ASSERT_TRUE(reconstructor);
  auto workspace = reconstructor->make_workspace();
  std::vector<float> db(reconstructor->levels());
  auto running = tests::must(reconstructor->make_running_background(1));
  const std::vector<std::byte> first(2 * samples, std::byte{100});
  const std::vector<std::byte> second(2 * samples, std::byte{200});
  reconstructor->reconstruct_b_scan_db(workspace, first, db, running.add(first));
  EXPECT_LT(db[0], -100);
  reconstructor->reconstruct_b_scan_db(workspace, second, db, running.add(second));
  EXPECT_NEAR(db[0], 20 * std::log10(50.0), 0.01);
}

// On both paths: a line at full scale is a wall of light, the third line clips a little.
TEST(Reconstructor, saturated_lines_are_no_brighter_than_their_neighbours) {
  constexpr int samples = 256;
  constexpr int lines = 7;
  for (const auto path : {ReconstructionPath::fftw, ReconstructionPath::fused}) {
    Calibration calibration = tests::chirped_calibration(samples, 5);
    calibration.background_mode = BackgroundMode::none;
    SpectrumFormat format{samples, hal::SampleType::u16};
    format.significant_bits = 12;
    const auto made = tests::must(Reconstructor::create({.calibration = calibration,
                                                         .format = format,
                                                         .a_scans = lines,
                                                         .path = path,
                                                         .limit_saturated_lines = true}));
    const auto drawn = noise(samples * lines, 8); // below full scale
    std::vector<std::uint16_t> frame(drawn.begin(), drawn.end());
    const auto of = [&] {
      auto workspace = made.make_workspace();
      std::vector<std::uint8_t> levels(made.levels());
      const int saturated =
          made.reconstruct_b_scan(workspace, std::as_bytes(std::span{frame}), levels)
              .saturated_lines;
      return std::pair{levels, saturated};
    };
    const auto good = of().first;
    for (const int line : {0, 3, 4})
      std::fill_n(frame.begin() + line * samples, samples, std::uint16_t{4095});
    const auto [limited, saturated] = of();
    EXPECT_EQ(saturated, 3);
    const std::size_t depths = good.size() / lines;
    const auto brighter = [&](std::size_t left, std::size_t right, std::size_t z) {
      return std::max(good[left * depths + z], good[right * depths + z]);
    };
    for (std::size_t z = 0; z < depths; ++z) {
      ASSERT_LE(limited[z], good[1 * depths + z]) << "one neighbour only";
      for (const std::size_t line : {3U, 4U})
        ASSERT_LE(limited[line * depths + z], brighter(2, 5, z));
      for (const std::size_t line : {1U, 2U, 5U, 6U})
        ASSERT_EQ(limited[line * depths + z], good[line * depths + z]);
    }
    EXPECT_EQ(limited[0], good[depths]) << "light at zero delay";

    // Levels that come with their bins are the same picture.
    std::vector<PackedBin> bins(made.levels());
    std::vector<std::uint8_t> with_bins(made.levels());
    auto workspace = made.make_workspace();
    EXPECT_EQ(
        made.reconstruct_b_scan_both(workspace, std::as_bytes(std::span{frame}), bins, with_bins)
            .saturated_lines,
        3);
    const auto by_line = made.saturated_lines(workspace);
    EXPECT_EQ((std::vector<int>{by_line.begin(), by_line.end()}),
              (std::vector{1, 0, 0, 1, 1, 0, 0}));
    EXPECT_GT(std::norm(bins.front().value()), 1e4F) << "bins stay as they are";
    EXPECT_EQ(with_bins, limited);

    std::ranges::fill(frame, std::uint16_t{4095});
    EXPECT_EQ(of().second, lines);
    EXPECT_GT(of().first.front(), limited[0]) << "no neighbour: shown as it is";
  }
}

} // namespace
} // namespace octascope::pipeline
