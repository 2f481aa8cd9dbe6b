#include <algorithm>
#include <atomic>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/rolling_volume.h"
#include "pipeline/volume/flow_scale.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

constexpr VolumeGeometry geometry{16, 24, 20, 1, 1, 1};
constexpr int count = geometry.b_scans;
constexpr int nowhere = -1; // no B-scan is shown by itself
constexpr hal::Duration period = 140ms;

// A bright edge that moves by one A-scan a volume: what is left of it is bright.
int edge_of(std::uint64_t number) {
  return static_cast<int>(number % geometry.a_scans);
}

hal::TimePoint exposed(std::uint64_t number, int b) {
  return hal::TimePoint{} + 1h + static_cast<std::int64_t>(number) * period + b * (period / count);
}

// A volume in the making, as workers leave it.
struct Making {
  explicit Making(std::uint64_t n) : number{n}, volume{geometry}, progress(count) {
    volume.occupancy = Occupancy{geometry, blank_depth_bins};
    volume.work.resize(count);
  }

  void finish(int b) {
    const auto at = static_cast<std::size_t>(b);
    for (int a = 0; a < geometry.a_scans; ++a)
      std::ranges::fill(
          volume.b_scan(b).subspan(static_cast<std::size_t>(a) * geometry.depths, geometry.depths),
          static_cast<std::uint8_t>(a < edge_of(number) ? 200 : 40));
    volume.occupancy.update(b, volume.b_scan(b));
    volume.b_scan_states[at] = BScanState::good;
    volume.work[at].first_line = exposed(number, b);
    volume.work[at].last_line = exposed(number, b + 1);
    progress[at].store(BScanProgress::finished);
  }
  void miss(int b) { progress[static_cast<std::size_t>(b)].store(BScanProgress::overdue); }

  Making& finish_all() {
    for (int b = 0; b < count; ++b)
      finish(b);
    return *this;
  }
  const Volume& published() {
    volume.metadata.index = number;
    volume.metadata.last_line = exposed(number, count);
    return volume;
  }
  VolumeInMaking lent() const { return {number, &volume, progress}; }

  std::uint64_t number;
  Volume volume;
  std::vector<std::atomic<BScanProgress>> progress;
};

// Where the edge lies in a B-scan that is shown; 0 if it is blank.
int edge_in(const Volume& volume, int b) {
  int edge = 0;
  for (int a = 0; a < geometry.a_scans; ++a)
    edge += volume.b_scan(b)[static_cast<std::size_t>(a) * geometry.depths] == 200 ? 1 : 0;
  return edge;
}

// No voxel without a known age, no mixture without a seam, never more than two volumes.
void expect_honest(const RollingVolume& rolling) {
  const Volume& shown = rolling.volume();
  const auto seam = rolling.seam();
  std::vector<std::uint64_t> numbers;
  for (int b = 0; b < count; ++b) {
    const auto at = static_cast<std::size_t>(b);
    const std::uint64_t number = rolling.number_of(b);
    const bool blank = std::ranges::all_of(shown.b_scan(b), [](int level) { return level == 0; });
    EXPECT_EQ(shown.b_scan_states[at] == BScanState::seam, seam && seam->b_scan == b) << b;
    if (!has_levels(shown.b_scan_states[at])) {
      EXPECT_TRUE(blank) << b;
    } else {
      EXPECT_EQ(edge_in(shown, b), edge_of(number)) << b;
      EXPECT_EQ(shown.work[at].last_line, exposed(number, b + 1)) << b;
    }
    if (number != 0 && (numbers.empty() || numbers.back() != number))
      numbers.push_back(number);
    if (seam && number != 0) {
      EXPECT_EQ(number == numbers.front(), b < seam->b_scan) << b;
    }
  }
  ASSERT_LE(numbers.size(), 2U);
  EXPECT_EQ(numbers.size() == 2, seam && seam->b_scan + 1 < count);
  if (numbers.size() == 2) {
    EXPECT_GT(numbers[0], numbers[1]) << "the newer comes first, as the scan does";
  }
  Occupancy expected{geometry, blank_depth_bins};
  expected.update(shown);
  for (int b = 0; b < count; ++b)
    EXPECT_TRUE(std::ranges::equal(shown.occupancy.highest(b), expected.highest(b))) << b;
}

struct RollingVolumeTest : testing::Test {
  RollingVolume rolling{geometry};
  Making first = [] {
    Making made{7};
    made.finish_all();
    return made;
  }();
  Making second{8};
};

TEST_F(RollingVolumeTest, shows_a_moving_edge_before_and_behind_the_seam_where_it_was_then) {
  rolling.take(first.published());
  for (int b = 0; b < 13; ++b)
    second.finish(b);
  rolling.follow(second.lent(), nowhere);
  expect_honest(rolling);
  const auto seam = rolling.seam();
  ASSERT_TRUE(seam);
  EXPECT_EQ(seam->b_scan, 13);
  EXPECT_EQ(edge_in(rolling.volume(), 12), edge_of(8));
  EXPECT_EQ(edge_in(rolling.volume(), 13), 0);
  EXPECT_EQ(edge_in(rolling.volume(), 14), edge_of(7));
  EXPECT_EQ(seam->newer, exposed(8, 13));
  EXPECT_EQ(seam->older, exposed(7, 15));
}

TEST_F(RollingVolumeTest, says_what_changed_and_nothing_else) {
  rolling.take(first.published());
  EXPECT_TRUE(std::ranges::equal(rolling.take_changes(), std::array{BScanRange{0, count}}));
  second.finish(0);
  second.finish(1);
  rolling.follow(second.lent(), nowhere);
  EXPECT_TRUE(std::ranges::equal(rolling.take_changes(), std::array{BScanRange{0, 3}}));
  rolling.follow(second.lent(), nowhere);
  EXPECT_TRUE(rolling.take_changes().empty());
  rolling.take(second.finish_all().published());
  EXPECT_TRUE(std::ranges::equal(rolling.take_changes(), std::array{BScanRange{2, count}}));
  EXPECT_FALSE(rolling.seam());
  expect_honest(rolling);
}

TEST_F(RollingVolumeTest, waits_for_its_turn_and_not_for_what_is_overdue) {
  rolling.take(first.published());
  second.finish(0);
  second.finish(3); // by a faster worker
  rolling.follow(second.lent(), nowhere);
  EXPECT_EQ(rolling.seam()->b_scan, 1);
  second.finish(1);
  second.miss(2);
  rolling.follow(second.lent(), nowhere);
  EXPECT_EQ(rolling.seam()->b_scan, 4);
  EXPECT_EQ(rolling.volume().b_scan_states[2], BScanState::missing);
  expect_honest(rolling);
  second.finish(2); // after all
  rolling.follow(second.lent(), nowhere);
  EXPECT_EQ(rolling.volume().b_scan_states[2], BScanState::good);
  expect_honest(rolling);
}

TEST_F(RollingVolumeTest, leaves_the_b_scan_that_is_shown_by_itself_clear_of_the_seam) {
  rolling.take(first.published());
  for (int b = 0; b < 9; ++b)
    second.finish(b);
  rolling.follow(second.lent(), 9);
  EXPECT_EQ(rolling.seam()->b_scan, 8);
  EXPECT_EQ(edge_in(rolling.volume(), 9), edge_of(7));
  second.finish(9);
  rolling.follow(second.lent(), 9);
  EXPECT_EQ(rolling.seam()->b_scan, 10);
  EXPECT_EQ(edge_in(rolling.volume(), 9), edge_of(8));
}

TEST_F(RollingVolumeTest, goes_on_with_another_volume_only_from_a_whole_one) {
  second.finish(0);
  rolling.follow(second.lent(), nowhere);
  EXPECT_FALSE(rolling.seam()) << "there is nothing to show it over";
  rolling.take(first.published());
  rolling.follow(second.lent(), nowhere);
  Making third{9};
  third.finish(0);
  third.finish(1);
  rolling.follow(third.lent(), nowhere);
  EXPECT_EQ(rolling.number_of(0), 8U);
  expect_honest(rolling);
  rolling.follow(first.lent(), nowhere);
  expect_honest(rolling);
}

// What flows is of the same volume as the levels; nothing does at the seam and where nothing came.
TEST_F(RollingVolumeTest, flow_goes_with_its_b_scan) {
  RollingVolume flowing{geometry, true};
  for (Making* const making : {&first, &second}) {
    making->volume.add_flow();
    making->volume.flow_marks = FlowMarks{geometry, blank_depth_bins};
    for (int b = 0; b < count; ++b) {
      making->volume.flow_states[static_cast<std::size_t>(b)] =
          b % 2 == 0 ? FlowState::left_out : FlowState::told;
      std::ranges::fill(making->volume.b_scan_flow(b),
                        b % 2 == 0 ? flow_untold : static_cast<std::uint8_t>(200 + making->number));
      making->volume.flow_marks.update(b, making->volume.b_scan_flow(b));
    }
  }
  flowing.take(first.published());
  for (const int b : {0, 1, 2, 4})
    second.finish(b);
  second.miss(3);
  flowing.follow(second.lent(), nowhere);
  ASSERT_EQ(flowing.seam()->b_scan, 5);
  const Volume& shown = flowing.volume();
  const auto expect_flow = [&](int b, FlowState state, int flow) {
    EXPECT_EQ(shown.flow_states[static_cast<std::size_t>(b)], state) << b;
    EXPECT_TRUE(std::ranges::all_of(shown.b_scan_flow(b), [=](int at) { return at == flow; })) << b;
    EXPECT_EQ(std::ranges::any_of(shown.flow_marks.of(b), [](auto word) { return word != 0; }),
              flow != flow_untold)
        << b;
  };
  expect_flow(0, FlowState::left_out, flow_untold);
  expect_flow(1, FlowState::told, 208);
  expect_flow(2, FlowState::left_out, flow_untold);
  expect_flow(3, FlowState::none, flow_untold); // missing
  expect_flow(4, FlowState::left_out, flow_untold);
  expect_flow(5, FlowState::none, flow_untold); // the seam
  expect_flow(6, FlowState::left_out, flow_untold);
  expect_flow(7, FlowState::told, 207);
  flowing.take(second.finish_all().published());
  EXPECT_EQ(shown.flow, second.volume.flow);
  EXPECT_EQ(shown.flow_states, second.volume.flow_states);
}

// Volumes that come whole or with gaps, some of which nobody sees; follow() and take() as they fall.
TEST_F(RollingVolumeTest, is_honest_whatever_comes_and_allocates_nothing) {
  std::mt19937 random{tests::fresh_seed()};
  rolling.take(first.published());
  for (std::uint64_t number = 8; number < 60; ++number) {
    Making making{number};
    const bool seen = random() % 5 != 0;
    std::vector<int> missed;
    for (int b = 0; b < count; ++b) {
      if (random() % 8 == 0)
        missed.push_back(b);
      else
        making.finish(b);
      if (b >= 2 && !missed.empty() && missed.back() == b - 2)
        making.miss(b - 2);
      if (!missed.empty() && random() % 16 == 0) {
        making.finish(missed.back()); // late
        missed.pop_back();
      }
      if (!seen || random() % 3 != 0)
        continue;
      const auto before = tests::allocations_of_this_thread();
      rolling.follow(making.lent(), static_cast<int>(random() % count));
      static_cast<void>(rolling.take_changes());
      EXPECT_EQ(tests::allocations_of_this_thread(), before);
      expect_honest(rolling);
    }
    if (random() % 4 == 0)
      continue; // replaced before it was taken
    rolling.take(making.published());
    EXPECT_FALSE(rolling.seam());
    EXPECT_EQ(rolling.volume().levels, making.volume.levels);
    expect_honest(rolling);
  }
}

} // namespace
} // namespace octascope::pipeline
