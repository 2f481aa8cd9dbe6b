#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/b_scan_builder.h"
#include "tests/support/allocation_counter.h"

namespace octascope::pipeline {
namespace {

// A line's levels are its first byte; a saturated line has 255 in it.
int first_byte_is_level(std::span<const std::byte> frame, std::span<std::uint8_t> levels,
                        std::size_t line_bytes, std::size_t depths) {
  int saturated = 0;
  for (std::size_t line = 0; line * depths < levels.size(); ++line) {
    const auto level = std::to_integer<std::uint8_t>(frame[line * line_bytes]);
    std::fill_n(levels.begin() + static_cast<std::ptrdiff_t>(line * depths), depths, level);
    saturated += level == 255 ? 1 : 0;
  }
  return saturated;
}

class BScanBuilderTest : public testing::Test {
protected:
  BScanBuilderTest() {
    plan.samples = 16;
    plan.a_scans = 5;
    plan.fly_back_lines = 2;
    plan.b_scans = 4;
    plan.turn_around_lines = 2;
  }
  BScanBuilder builder() const {
    const std::size_t depths = static_cast<std::size_t>(plan.samples / 2);
    const std::size_t line_bytes = static_cast<std::size_t>(plan.samples) * 2;
    return {plan, 2, [=](std::size_t, const hal::LineFrame& frame, std::span<std::uint8_t> out) {
              return first_byte_is_level(frame.bytes, out, line_bytes, depths);
            }};
  }
  // A frame of which line l is `first + step·l`.
  hal::LineFrame frame(int first, int step) {
    auto& bytes = memory.emplace_back(static_cast<std::size_t>(plan.lines_per_frame()) * 32);
    for (int line = 0; line < plan.lines_per_frame(); ++line)
      bytes[static_cast<std::size_t>(line) * 32] = static_cast<std::byte>(first + step * line);
    hal::LineFrame made;
    made.buffer = static_cast<int>(memory.size());
    made.bytes = bytes;
    return made;
  }
  std::vector<int> levels_by_a_scan() const {
    std::vector<int> result;
    for (std::size_t a = 0; a < 5; ++a)
      result.push_back(levels[a * 8 + 3]);
    return result;
  }

  ScanPlan plan;
  std::vector<std::vector<std::byte>> memory;
  std::vector<std::uint8_t> levels = std::vector<std::uint8_t>(40);
};

TEST_F(BScanBuilderTest, backward_sweeps_are_turned_round) {
  plan.bidirectional = true;
  memory.reserve(4);
  BScanBuilder maker = builder();
  const SweepAlignment alignment{plan, 1};
  const std::array forward{frame(10, 1)};
  maker.build(0, 2, forward, alignment, nullptr, levels);
  EXPECT_EQ(levels_by_a_scan(), (std::vector{11, 12, 13, 14, 15}));
  const std::array backward{frame(10, 1)};
  maker.build(1, 1, backward, alignment, nullptr, levels);
  EXPECT_EQ(levels_by_a_scan(), (std::vector{15, 14, 13, 12, 11}));
}

TEST_F(BScanBuilderTest, repeats_that_came_are_averaged_in_their_directions) {
  plan.bidirectional = true;
  plan.repeats = 3;
  memory.reserve(4);
  BScanBuilder maker = builder();
  const SweepAlignment alignment{plan, 0};
  // Sweeps 3, 4, 5: backwards, forwards, backwards.
  std::array frames{frame(104, -1), frame(100, 1), frame(107, -1)};
  EXPECT_EQ(maker.build(0, 1, frames, alignment, nullptr, levels), 0);
  EXPECT_EQ(levels_by_a_scan(), (std::vector{101, 102, 103, 104, 105}));
  frames[2].buffer = -1;
  maker.build(0, 1, frames, alignment, nullptr, levels);
  EXPECT_EQ(levels_by_a_scan(), (std::vector{100, 101, 102, 103, 104}));
  frames[1].buffer = -1;
  maker.build(0, 1, frames, alignment, nullptr, levels);
  EXPECT_EQ(levels_by_a_scan(), (std::vector{100, 101, 102, 103, 104}));
}

TEST_F(BScanBuilderTest, saturated_lines_of_all_repeats_count) {
  plan.repeats = 2;
  memory.reserve(4);
  BScanBuilder maker = builder();
  const std::array frames{frame(252, 1), frame(255, 0)};
  EXPECT_EQ(maker.build(0, 0, frames, SweepAlignment{plan, 0}, nullptr, levels), 1 + 5);
}

TEST_F(BScanBuilderTest, allocates_nothing) {
  plan.bidirectional = true;
  plan.repeats = 2;
  memory.reserve(4);
  BScanBuilder maker = builder();
  DownsampledSweep sketch{plan};
  const std::array frames{frame(10, 1), frame(20, 1)};
  const auto before = tests::allocations_of_this_thread();
  const SweepAlignment alignment{plan, 0.3};
  sketch.clear();
  maker.build(1, 3, frames, alignment, &sketch, levels);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
  EXPECT_TRUE(sketch.came(6));
  EXPECT_TRUE(sketch.came(7));
  EXPECT_FALSE(sketch.came(5));
  EXPECT_EQ(sketch.line(7, 3)[0], 23);
}

TEST(AverageRepeats, rounds_to_the_nearest_count) {
  std::mt19937 random{5};
  std::uniform_int_distribution<int> byte{0, 255};
  for (int count = 1; count <= ScanPlan::most_repeats; ++count) {
    constexpr std::size_t size = 5000;
    std::vector<std::uint8_t> repeats(size * static_cast<std::size_t>(count));
    std::ranges::generate(repeats, [&] { return static_cast<std::uint8_t>(byte(random)); });
    std::vector<std::uint8_t> average(size);
    average_repeats(repeats, count, average);
    for (std::size_t i = 0; i < size; ++i) {
      double sum = 0;
      for (int repeat = 0; repeat < count; ++repeat)
        sum += repeats[static_cast<std::size_t>(repeat) * size + i];
      ASSERT_EQ(average[i], std::lround(sum / count)) << count << ", " << i;
    }
  }
}

} // namespace
} // namespace octascope::pipeline
