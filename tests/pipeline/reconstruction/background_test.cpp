// The running background: by its recurrence, in any number of threads, without allocation; and
// which one is taken of few lines.
#include <algorithm>
#include <cstdint>
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

constexpr int samples = 256;
constexpr int a_scans = 7;
constexpr int b_scans = 40;

using BScan = std::vector<std::uint16_t>;

std::vector<BScan> draw_b_scans(std::size_t count = b_scans, int lines = a_scans) {
  std::mt19937 generator{23};
  std::vector<BScan> all(count, BScan(samples * static_cast<std::size_t>(lines)));
  for (std::size_t b = 0; b < count; ++b) // light that drifts
    for (auto& sample : all[b])
      sample = static_cast<std::uint16_t>(1000 + 20 * b + generator() % 300);
  return all;
}

std::span<const std::byte> bytes(const BScan& b_scan) {
  return std::as_bytes(std::span{b_scan});
}

// The mean over lines a = first, first + stride … of a B-scan.
double mean_at(const BScan& b_scan, std::size_t p, std::size_t first, std::size_t stride) {
  double sum = 0;
  double lines = 0;
  for (std::size_t i = first * samples + p; i < b_scan.size(); i += stride * samples, ++lines)
    sum += b_scan[i];
  return sum / lines;
}

TEST(RunningBackground, follows_its_recurrence) {
  constexpr int many_a_scans = 70; // every second one is taken, the others next time
  const auto all = draw_b_scans(100, many_a_scans);
  RunningBackground running{SpectrumFormat{samples, hal::SampleType::u16}, many_a_scans, 10};
  EXPECT_EQ(running.window(), 64);
  EXPECT_EQ(running.stride(), 2);
  std::vector<double> expected(samples);
  for (std::size_t b = 0; b < all.size(); ++b) {
    const auto found = running.add(bytes(all[b]));
    for (std::size_t p = 0; p < samples; ++p) {
      expected[p] +=
          (mean_at(all[b], p, b % 2, 2) - expected[p]) / std::min(static_cast<int>(b) + 1, 64);
      ASSERT_NEAR(static_cast<double>(found[p]), expected[p], 1e-3);
    }
  }
}

TEST(RunningBackground, follows_another_light_within_some_volumes) {
  RunningBackground running{SpectrumFormat{samples, hal::SampleType::u16}, a_scans, b_scans};
  EXPECT_EQ(running.window(), 2 * b_scans);
  const auto after = [&](int volumes, std::uint16_t light) {
    const BScan b_scan(samples * a_scans, light);
    for (int b = 1; b < volumes * b_scans; ++b)
      running.add(bytes(b_scan));
    return running.add(bytes(b_scan)).front();
  };
  EXPECT_EQ(after(10, 1000), 1000);
  EXPECT_NEAR(after(5, 2000), 2000, 100); // 8 % of the step are left
}

TEST(RunningBackground, leaves_saturated_lines_out) {
  SpectrumFormat format{samples, hal::SampleType::u16};
  format.significant_bits = 12;
  format.right_shift = 4;
  BScan b_scan(samples * a_scans, 1000 << 4);
  b_scan[3 * samples + 7] = 4095 << 4;
  std::fill_n(b_scan.begin() + 5 * samples, samples, std::uint16_t{4095 << 4});
  const BScan lost(samples * a_scans, 4095 << 4);
  RunningBackground running{format, a_scans, b_scans};
  EXPECT_EQ(running.add(bytes(lost))[7], 4095) << "there is nothing else yet";
  for (const BScan& next : {b_scan, lost, b_scan})
    for (const float value : running.add(bytes(next)))
      ASSERT_EQ(value, 1000);
}

// B-scans are handed out in order and worked off by `workers` threads, whichever is free.
std::vector<std::uint8_t> work_off(const std::vector<BScan>& all, ReconstructionPath path,
                                   int workers) {
  Calibration calibration = tests::chirped_calibration(samples, 15);
  calibration.background_mode = BackgroundMode::running;
  const auto made = Reconstructor::create(
      {calibration, SpectrumFormat{samples, hal::SampleType::u16}, a_scans, path});
  EXPECT_TRUE(made);
  FrameBackgrounds backgrounds{*made->make_running_background(b_scans), samples, b_scans};
  std::vector<hal::LineFrame> frames(b_scans);
  for (int b = 0; b < b_scans; ++b) {
    hal::LineFrame& frame = frames[static_cast<std::size_t>(b)];
    frame.buffer = b_scans - 1 - b;
    frame.bytes = bytes(all[static_cast<std::size_t>(b)]);
    backgrounds.take(frame);
  }
  std::vector<std::uint8_t> levels(made->levels() * b_scans);
  std::vector<std::jthread> threads;
  for (int w = 0; w < workers; ++w)
    threads.emplace_back([&, w] {
      auto workspace = made->make_workspace();
      for (int b = b_scans - 1 - w; b >= 0; b -= workers) { // backwards: no order is given
        const auto& frame = frames[static_cast<std::size_t>(b)];
        made->reconstruct_b_scan(
            workspace, frame.bytes,
            std::span{levels}.subspan(made->levels() * static_cast<std::size_t>(b), made->levels()),
            backgrounds.of(frame));
      }
    });
  threads.clear();
  return levels;
}

TEST(RunningBackground, does_not_depend_on_the_number_of_workers) {
  const auto all = draw_b_scans();
  for (const auto path : {ReconstructionPath::fftw, ReconstructionPath::fused}) {
    const auto alone = work_off(all, path, 1);
    EXPECT_EQ(work_off(all, path, 2), alone);
    EXPECT_EQ(work_off(all, path, 5), alone);
    EXPECT_GT(*std::ranges::max_element(alone), 0);
  }
}

TEST(RunningBackground, that_is_not_given_is_the_mean_of_the_b_scan) {
  const auto all = draw_b_scans();
  Calibration calibration = tests::chirped_calibration(samples, 15);
  const auto levels_with = [&](BackgroundMode mode, const BScan& b_scan) {
    calibration.background_mode = mode;
    const auto made = tests::must(
        Reconstructor::create({calibration, SpectrumFormat{samples, hal::SampleType::u16}, a_scans,
                               ReconstructionPath::fftw}));
    auto workspace = made.make_workspace();
    std::vector<std::uint8_t> levels(made.levels());
    made.reconstruct_b_scan(workspace, bytes(all[7]), levels); // leaves nothing behind
    made.reconstruct_b_scan(workspace, bytes(b_scan), levels);
    return levels;
  };
  EXPECT_EQ(levels_with(BackgroundMode::running, all[3]),
            levels_with(BackgroundMode::mean, all[3]));
}

TEST(RunningBackground, is_there_for_its_mode_alone) {
  const SpectrumFormat format{samples, hal::SampleType::u16};
  for (const auto mode : {BackgroundMode::mean, BackgroundMode::none}) {
    Calibration calibration = Calibration::identity(samples);
    calibration.background_mode = mode;
    const auto made = tests::must(Reconstructor::create({calibration, format, a_scans}));
    EXPECT_FALSE(made.make_running_background(b_scans));
  }
}

TEST(Background, of_few_lines_is_another) {
  using enum BackgroundMode;
  struct Case {
    BackgroundMode given;
    int a_scans;
    int b_scans;
    BackgroundMode taken;
  };
  for (const Case& c : {Case{mean, 1, 1, none}, Case{running, 1, 1, none},
                        Case{mean, 1, 9, running}, Case{running, 1, 9, running},
                        Case{file, 1, 1, file}, Case{none, 1, 1, none}, Case{mean, 2, 1, mean}}) {
    Calibration calibration = Calibration::identity(samples);
    calibration.background_mode = c.given;
    const auto told = replace_background_of_few_lines(calibration, c.a_scans, c.b_scans);
    EXPECT_EQ(calibration.background_mode, c.taken);
    EXPECT_EQ(told.has_value(), c.taken != c.given);
  }
}

TEST(RunningBackground, allocates_nothing) {
  const auto all = draw_b_scans();
  FrameBackgrounds backgrounds{
      RunningBackground{SpectrumFormat{samples, hal::SampleType::u16}, a_scans, 1}, samples, 2};
  hal::LineFrame frame;
  frame.buffer = 1;
  frame.bytes = bytes(all.front());
  const auto before = tests::allocations_of_this_thread();
  ASSERT_GT(before, 0U);
  backgrounds.take(frame);
  EXPECT_NEAR(backgrounds.of(frame).front(), 1150, 150);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
}

} // namespace
} // namespace octascope::pipeline
