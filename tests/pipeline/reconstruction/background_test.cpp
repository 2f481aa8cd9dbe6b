// The running background: by its recurrence, in any number of threads, without allocation.
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

std::vector<BScan> draw_b_scans() {
  std::mt19937 generator{23};
  std::vector<BScan> all(b_scans, BScan(samples * a_scans));
  for (int b = 0; b < b_scans; ++b) // light that drifts
    for (auto& count : all[static_cast<std::size_t>(b)])
      count = static_cast<std::uint16_t>(1000 + 20 * b + static_cast<int>(generator() % 300));
  return all;
}

std::span<const std::byte> bytes(const BScan& b_scan) {
  return std::as_bytes(std::span{b_scan});
}

TEST(RunningBackground, follows_its_recurrence) {
  const auto all = draw_b_scans();
  RunningBackground running{SpectrumFormat{samples, hal::SampleType::u16}, a_scans};
  std::vector<double> expected(samples);
  for (int b = 0; b < b_scans; ++b) {
    const BScan& b_scan = all[static_cast<std::size_t>(b)];
    const auto found = running.add(bytes(b_scan));
    for (std::size_t p = 0; p < samples; ++p) {
      double mean = 0;
      for (std::size_t a = 0; a < a_scans; ++a)
        mean += b_scan[a * samples + p] / static_cast<double>(a_scans);
      expected[p] += (mean - expected[p]) / std::min(b + 1, 16);
      ASSERT_NEAR(static_cast<double>(found[p]), expected[p], 1e-3);
    }
  }
  running.reset();
  const auto afresh = running.add(bytes(all.front()));
  RunningBackground other{SpectrumFormat{samples, hal::SampleType::u16}, a_scans};
  EXPECT_TRUE(std::ranges::equal(afresh, other.add(bytes(all.front()))));
}

// B-scans are handed out in order and worked off by `workers` threads, whichever is free.
std::vector<std::uint8_t> work_off(const std::vector<BScan>& all, ReconstructionPath path,
                                   int workers) {
  Calibration calibration = tests::chirped_calibration(samples, 15);
  calibration.background_mode = BackgroundMode::running;
  const auto made = Reconstructor::create(
      {calibration, SpectrumFormat{samples, hal::SampleType::u16}, a_scans, path});
  EXPECT_TRUE(made);
  FrameBackgrounds backgrounds{*made->make_running_background(), samples, b_scans};
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

TEST(RunningBackground, one_workspace_that_sees_all_in_order_gives_the_same) {
  const auto all = draw_b_scans();
  Calibration calibration = tests::chirped_calibration(samples, 15);
  calibration.background_mode = BackgroundMode::running;
  const auto made =
      tests::must(Reconstructor::create({calibration, SpectrumFormat{samples, hal::SampleType::u16},
                                         a_scans, ReconstructionPath::fftw}));
  auto own = made.make_workspace();
  auto given = made.make_workspace();
  auto running = tests::must(made.make_running_background());
  std::vector<std::uint8_t> one(made.levels());
  std::vector<std::uint8_t> other(made.levels());
  for (const BScan& b_scan : all) {
    made.reconstruct_b_scan(own, bytes(b_scan), one);
    made.reconstruct_b_scan(given, bytes(b_scan), other, running.add(bytes(b_scan)));
    ASSERT_EQ(one, other);
  }
}

TEST(RunningBackground, is_there_for_its_mode_alone) {
  const SpectrumFormat format{samples, hal::SampleType::u16};
  for (const auto mode : {BackgroundMode::mean, BackgroundMode::none}) {
    Calibration calibration = Calibration::identity(samples);
    calibration.background_mode = mode;
    const auto made = tests::must(Reconstructor::create({calibration, format, a_scans}));
    EXPECT_FALSE(made.make_running_background());
  }
}

TEST(RunningBackground, allocates_nothing) {
  const auto all = draw_b_scans();
  FrameBackgrounds backgrounds{
      RunningBackground{SpectrumFormat{samples, hal::SampleType::u16}, a_scans}, samples, 2};
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
