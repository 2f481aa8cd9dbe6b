#include <algorithm>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/volume_assembler.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

constexpr VolumeGeometry geometry{40, 24, 13, 1, 1, 1};

class VolumeAssemblerTest : public testing::Test {
protected:
  VolumeAssemblerTest() : built_{geometry}, volume_{geometry} {
    volume_.occupancy = Occupancy{geometry, 2};
    for (std::uint8_t& level : built_.levels)
      level = static_cast<std::uint8_t>(generator_());
  }

  void begin() {
    std::ranges::fill(volume_.b_scan_states, BScanState::missing);
    std::ranges::fill(volume_.levels, std::uint8_t{77}); // of the volume before
    assembler_.begin(volume_);
  }

  void build(int b) {
    std::ranges::copy(built_.b_scan(b), assembler_.own_levels(b).begin());
    volume_.b_scan_states[static_cast<std::size_t>(b)] = BScanState::good;
    assembler_.built(b);
  }

  void expect_as_if_averaged_at_the_end() {
    const auto levels = [&](int b) {
      return b >= 0 && b < geometry.b_scans &&
                     volume_.b_scan_states[static_cast<std::size_t>(b)] == BScanState::good
                 ? std::span<const std::uint8_t>{built_.b_scan(b)}
                 : std::span<const std::uint8_t>{};
    };
    Volume expected{geometry};
    expected.occupancy = Occupancy{geometry, 2};
    for (int b = 0; b < geometry.b_scans; ++b) {
      if (!levels(b).empty())
        average_.average(levels(b - 1), levels(b), levels(b + 1), expected.b_scan(b));
    }
    expected.occupancy.update(expected);
    EXPECT_EQ(volume_.levels, expected.levels);
    for (int b = 0; b < geometry.b_scans; ++b) {
      EXPECT_TRUE(std::ranges::equal(volume_.occupancy.highest(b), expected.occupancy.highest(b)));
      EXPECT_TRUE(std::ranges::equal(volume_.occupancy.lowest(b), expected.occupancy.lowest(b)));
    }
  }

  std::mt19937 generator_{tests::fresh_seed()};
  NeighbourAverage average_ = *NeighbourAverage::create({});
  VolumeAssembler assembler_{geometry, average_};
  Volume built_; // before averaging
  Volume volume_;
};

TEST_F(VolumeAssemblerTest, a_b_scan_is_finished_when_its_neighbours_are_there) {
  begin();
  build(3);
  build(5);
  EXPECT_EQ(volume_.b_scan(4)[0], 77);
  build(4);
  std::vector<std::uint8_t> expected(geometry.b_scan_voxels());
  average_.average(built_.b_scan(3), built_.b_scan(4), built_.b_scan(5), expected);
  EXPECT_TRUE(std::ranges::equal(volume_.b_scan(4), expected));
  EXPECT_EQ(volume_.b_scan(3)[0], 77) << "it waits for its other neighbour";
}

TEST_F(VolumeAssemblerTest, what_is_overdue_is_not_waited_for) {
  begin();
  build(0);
  build(1);
  build(3);
  build(4);
  EXPECT_EQ(volume_.b_scan(1)[0], 77);
  EXPECT_EQ(assembler_.progress()[1].load(), BScanProgress::awaited);
  assembler_.overdue(2);
  EXPECT_EQ(assembler_.progress()[2].load(), BScanProgress::overdue);
  std::vector<std::uint8_t> expected(geometry.b_scan_voxels());
  average_.average(built_.b_scan(0), built_.b_scan(1), {}, expected);
  EXPECT_EQ(assembler_.progress()[1].load(), BScanProgress::finished);
  EXPECT_TRUE(std::ranges::equal(volume_.b_scan(1), expected));
  average_.average({}, built_.b_scan(3), built_.b_scan(4), expected);
  EXPECT_TRUE(std::ranges::equal(volume_.b_scan(3), expected));
  build(2); // after all: what is finished stays as it is
  EXPECT_EQ(assembler_.progress()[2].load(), BScanProgress::finished);
  average_.average(built_.b_scan(1), built_.b_scan(2), built_.b_scan(3), expected);
  EXPECT_TRUE(std::ranges::equal(volume_.b_scan(2), expected));
  average_.average({}, built_.b_scan(3), built_.b_scan(4), expected);
  EXPECT_TRUE(std::ranges::equal(volume_.b_scan(3), expected));
}

TEST_F(VolumeAssemblerTest, any_order_gives_the_same_volume) {
  std::vector<int> order(geometry.b_scans);
  std::iota(order.begin(), order.end(), 0);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::ranges::shuffle(order, generator_);
    begin();
    for (const int b : order)
      build(b);
    assembler_.finish();
    expect_as_if_averaged_at_the_end();
  }
}

TEST_F(VolumeAssemblerTest, what_is_missing_is_blank_and_counts_for_nothing) {
  for (int repeat = 0; repeat < 50; ++repeat) {
    begin();
    for (int b = 0; b < geometry.b_scans; ++b)
      if (generator_() % 3 != 0)
        build(b);
    assembler_.finish();
    expect_as_if_averaged_at_the_end();
  }
}

TEST_F(VolumeAssemblerTest, what_is_missing_may_be_overdue_at_any_time) {
  for (int repeat = 0; repeat < 50; ++repeat) {
    begin();
    for (int b = 0; b < geometry.b_scans; ++b)
      if (generator_() % 3 != 0)
        build(b);
      else
        assembler_.overdue(b);
    assembler_.finish();
    expect_as_if_averaged_at_the_end();
  }
}

TEST_F(VolumeAssemblerTest, several_threads_finish_each_b_scan_once) {
  for (int repeat = 0; repeat < 200; ++repeat) {
    begin();
    {
      std::vector<std::jthread> workers;
      for (int worker = 0; worker < 3; ++worker)
        workers.emplace_back([&, worker] {
          for (int b = worker; b < geometry.b_scans; b += 3)
            build(b);
        });
    }
    assembler_.finish();
    expect_as_if_averaged_at_the_end();
  }
}

TEST_F(VolumeAssemblerTest, allocates_nothing) {
  const auto before = tests::allocations_of_this_thread();
  begin();
  for (int b = 0; b < geometry.b_scans; ++b)
    build(b);
  assembler_.finish();
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
}

} // namespace
} // namespace octascope::pipeline
