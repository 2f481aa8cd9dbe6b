// What a replay shows, and when: with times of the test's own, and a recording that it makes up.
#include <algorithm>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/recordings/replay/replay_player.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/small_recording.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr hal::TimePoint start{std::chrono::hours{7}};

// A replayed volume as it was taken.
struct Taken {
  hal::Duration after; // since the start
  std::uint64_t index;
};

class ReplayPlayerTest : public testing::Test {
protected:
  // Volumes 141 ms apart, with the history of small_recording_entry(); one is lost after the
  // second.
  ReplaySource source(std::uint64_t volumes) {
    ReplaySource made;
    made.facts = tests::small_recording_facts();
    for (std::uint64_t n = 0; n < volumes; ++n)
      made.volumes.push_back(tests::small_recording_entry(n));
    made.read = [this](std::size_t n, Volume& volume) -> hal::Result<> {
      if (broken.contains(n))
        return hal::fail(hal::ErrorCode::bad_data, "volume " + std::to_string(n) + " is broken");
      const Volume written = tests::small_recording_volume(n);
      std::ranges::copy(written.levels, volume.levels.begin());
      std::ranges::fill(volume.b_scan(1), std::uint8_t{99}); // although it is missing
      std::ranges::copy(written.b_scan_states, volume.b_scan_states.begin());
      volume.metadata = written.metadata;
      ++reads;
      return {};
    };
    return made;
  }
  ReplayPlayer& play(ReplaySource what, const ReplaySetup& setup = {}) {
    player.emplace(std::move(what), setup, faults, news);
    return *player;
  }

  // Until `end` after the start; every volume is taken at once.
  std::vector<Taken> taken_until(hal::Duration end) {
    std::vector<Taken> taken;
    while (now < start + end) {
      const hal::TimePoint next = player->step(now);
      if (const Volume* volume = player->take_newest())
        taken.push_back({now - start, volume->metadata.index});
      if (player->end() != ReplayEnd::none)
        break;
      EXPECT_LE(next, now + 1s) << "a thread that shows no life";
      now = std::max(next, now);
    }
    return taken;
  }
  static std::vector<std::uint64_t> indices(const std::vector<Taken>& taken) {
    std::vector<std::uint64_t> all;
    for (const Taken& volume : taken)
      all.push_back(volume.index);
    return all;
  }
  void expect_balance() {
    const VolumeCounters c = player->counters();
    EXPECT_EQ(c.planned, c.acquired + c.lost_volumes + c.unfinished);
    EXPECT_EQ(c.acquired, c.published);
  }

  std::set<std::size_t> broken;
  int reads = 0;
  FaultLog faults;
  Wakeup news;
  hal::TimePoint now = start;
  std::optional<ReplayPlayer> player;
};

TEST_F(ReplayPlayerTest, shows_volumes_in_order_at_the_recorded_times) {
  play(source(6), {.once = true});
  const std::vector<Taken> taken = taken_until(10s);
  EXPECT_THAT(indices(taken), ElementsAre(1, 2, 4, 5, 6, 7));
  for (std::size_t n = 0; n < taken.size(); ++n)
    EXPECT_EQ(taken[n].after, static_cast<int>(n) * 141ms) << n;
  EXPECT_EQ(player->end(), ReplayEnd::done);
  EXPECT_EQ(player->counters().lost_volumes, 1U) << "between the second and the third";
  EXPECT_EQ(player->counters().lost_b_scans, 5U + 6U) << "all of that one, one of each other";
  expect_balance();
}

TEST_F(ReplayPlayerTest, goes_faster_and_slower) {
  play(source(4), {.rate = 2, .once = true});
  EXPECT_EQ(taken_until(10s).back().after, 3 * 70'500us);
  now = start;
  play(source(4), {.rate = 0.5, .once = true});
  EXPECT_EQ(taken_until(10s).back().after, 3 * 282ms);
}

TEST_F(ReplayPlayerTest, begins_anew_a_period_after_the_last) {
  play(source(3));
  const std::vector<Taken> taken = taken_until(141ms * 7);
  EXPECT_THAT(indices(taken), ElementsAre(1, 2, 4, 1, 2, 4, 1));
  EXPECT_EQ(taken[3].after, 3 * 141ms);
  EXPECT_EQ(player->end(), ReplayEnd::none);
  EXPECT_EQ(player->counters().lost_volumes, 2U) << "none from the last to the first";
}

TEST_F(ReplayPlayerTest, a_gap_stays_and_a_long_pause_is_shortened) {
  ReplaySource with_gaps = source(4);
  const auto delay = [&](std::size_t from, hal::Duration by) {
    for (std::size_t n = from; n < 4; ++n)
      with_gaps.volumes[n].published_ns += by.count();
  };
  delay(2, 3s);
  delay(3, 1h);
  play(std::move(with_gaps), {.once = true});
  const std::vector<Taken> taken = taken_until(1min);
  ASSERT_EQ(taken.size(), 4U);
  EXPECT_EQ(taken[2].after, 2 * 141ms + 3s);
  EXPECT_EQ(taken[3].after, taken[2].after + ReplaySchedule::shortened_pause);
  EXPECT_EQ(player->schedule().left_out_before(2), 0s);
  EXPECT_EQ(player->schedule().left_out_before(3), 1h + 141ms - ReplaySchedule::shortened_pause);
}

TEST_F(ReplayPlayerTest, times_that_cannot_be_right_do_no_harm) {
  ReplaySource wrong = source(4);
  wrong.facts.volume_period_s = 1e300;
  wrong.volumes[1].published_ns = std::numeric_limits<std::int64_t>::min();
  wrong.volumes[2].published_ns = std::numeric_limits<std::int64_t>::max();
  wrong.volumes[2].last_line_ns = std::numeric_limits<std::int64_t>::min();
  wrong.volumes[3].index = std::numeric_limits<std::uint64_t>::max();
  play(std::move(wrong), {.once = true});
  EXPECT_EQ(taken_until(1min).size(), 4U);
  expect_balance();
}

TEST_F(ReplayPlayerTest, a_volumes_history_is_moved_to_now_and_says_what_it_is) {
  play(source(3));
  taken_until(100ms);
  player->step(now = start + 141ms); // has been read ahead
  const Volume* volume = player->take_newest();
  ASSERT_NE(volume, nullptr);
  const VolumeMetadata& metadata = volume->metadata;
  EXPECT_EQ(metadata.index, 2U);
  EXPECT_EQ(metadata.published, start + 141ms);
  EXPECT_EQ(metadata.last_line, metadata.published - 3ms);
  EXPECT_EQ(metadata.first_line, metadata.published - 137ms);
  EXPECT_EQ(metadata.recorded_ns, tests::small_recording_entry(1).wall_clock_ns);
  EXPECT_EQ(metadata.saturated_lines, 3);
}

TEST_F(ReplayPlayerTest, missing_b_scans_are_blank_and_the_occupancy_is_the_volumes) {
  play(source(2));
  taken_until(1ms);
  player->step(now = start + 141ms);
  const Volume* volume = player->take_newest();
  ASSERT_NE(volume, nullptr);
  const Volume written = tests::small_recording_volume(1);
  EXPECT_EQ(volume->b_scan_states, written.b_scan_states);
  EXPECT_EQ(volume->missing_b_scans(), 1);
  EXPECT_EQ(volume->levels, written.levels) << "the missing one is blank";
  Occupancy expected{written.geometry, blank_depth_bins};
  expected.update(written);
  for (int b = 0; b < expected.bricks().b; ++b)
    EXPECT_TRUE(std::ranges::equal(volume->occupancy.highest(b), expected.highest(b))) << b;
}

TEST_F(ReplayPlayerTest, goes_on_after_a_volume_that_cannot_be_read_and_tells) {
  broken = {1};
  play(source(4), {.once = true});
  const std::vector<Taken> taken = taken_until(10s);
  EXPECT_THAT(indices(taken), ElementsAre(1, 4, 5));
  EXPECT_EQ(taken[1].after, 2 * 141ms) << "its time passes";
  EXPECT_EQ(player->end(), ReplayEnd::done);
  ASSERT_EQ(faults.records().size(), 1U);
  EXPECT_EQ(faults.records()[0].kind, Fault::unreadable_volume);
  EXPECT_THAT(faults.records()[0].message, HasSubstr("volume 1 is broken"));
  EXPECT_EQ(player->counters().lost_volumes, 2U) << "it and the one that was lost";
  expect_balance();
}

// As HDF5 reads it from a file that was cut off.
TEST_F(ReplayPlayerTest, a_volume_of_which_nothing_came_counts_as_unreadable) {
  ReplaySource cut_off = source(3);
  cut_off.read = [read = cut_off.read](std::size_t n, Volume& volume) {
    auto done = read(n, volume);
    if (n == 1)
      std::ranges::fill(volume.b_scan_states, BScanState::missing);
    return done;
  };
  play(std::move(cut_off), {.once = true});
  EXPECT_THAT(indices(taken_until(10s)), ElementsAre(1, 4));
  ASSERT_EQ(faults.records().size(), 1U);
  EXPECT_THAT(faults.records()[0].message, HasSubstr("found none of its 5 B-scans"));
}

TEST_F(ReplayPlayerTest, ends_when_nothing_can_be_read_any_more) {
  play(source(3));
  taken_until(200ms);
  broken = {0, 1, 2}; // the disk is gone
  taken_until(1min);
  EXPECT_EQ(player->end(), ReplayEnd::unreadable);
  EXPECT_LT(now, start + 2s);
}

TEST_F(ReplayPlayerTest, ends_after_so_many_volumes) {
  play(source(3), {.most_volumes = 5});
  EXPECT_EQ(taken_until(1min).size(), 5U);
  EXPECT_EQ(player->end(), ReplayEnd::done);
}

TEST_F(ReplayPlayerTest, goes_where_it_is_told_and_on_from_there) {
  play(source(6));
  player->seek(3);
  std::vector<Taken> taken = taken_until(300ms);
  EXPECT_THAT(indices(taken), ElementsAre(5, 6, 7));
  EXPECT_EQ(taken[0].after, 0s);
  player->seek(1);
  const hal::Duration asked = now - start;
  taken = taken_until(asked + 200ms);
  EXPECT_THAT(indices(taken), ElementsAre(2, 4));
  EXPECT_EQ(taken[0].after, asked);
  player->seek(1000); // the last there is
  EXPECT_EQ(taken_until(now - start + 100ms).front().index, 7U);
}

TEST_F(ReplayPlayerTest, what_is_held_stands_still_and_goes_on_from_there) {
  play(source(6));
  taken_until(200ms); // two, the next is due at 282 ms
  now = start + 200ms;
  player->hold(true);
  EXPECT_TRUE(taken_until(10s).empty());
  now = start + 10s + 200ms;
  player->hold(false);
  const std::vector<Taken> taken = taken_until(10s + 450ms);
  EXPECT_THAT(indices(taken), ElementsAre(4, 5));
  EXPECT_EQ(taken[0].after, 10s + 2 * 141ms);
  EXPECT_EQ(taken[1].after - taken[0].after, 141ms);
}

// A slow disk, or a machine that slept.
TEST_F(ReplayPlayerTest, is_late_without_a_rush) {
  play(source(20));
  taken_until(200ms);
  now += 5s;
  const std::vector<Taken> taken = taken_until(now - start + 1s);
  EXPECT_LE(taken.size(), 9U);
  for (std::size_t n = 2; n < taken.size(); ++n)
    EXPECT_EQ(taken[n].after - taken[n - 1].after, 141ms);
}

TEST_F(ReplayPlayerTest, a_renderer_that_is_slow_gets_the_newest) {
  play(source(4), {.once = true});
  while (player->end() == ReplayEnd::none)
    now = std::max(player->step(now), now);
  EXPECT_TRUE(player->has_newer());
  EXPECT_EQ(player->take_newest()->metadata.index, 5U);
  EXPECT_EQ(player->take_newest(), nullptr);
  EXPECT_EQ(player->counters().skipped, 3U);
}

TEST(ReplayedFile, is_read_a_volume_at_a_time_and_allocates_nothing) {
  const tests::ScratchFolder folder;
  tests::write_small_recording(folder / "r.h5", 8);
  auto reader = tests::must(RecordingReader::open(folder / "r.h5"));
  auto source = tests::must(replay_source(std::move(reader)));
  FaultLog faults;
  Wakeup news;
  ReplayPlayer player{std::move(source), {}, faults, news};
  hal::TimePoint now = start;
  const auto play_volumes = [&](std::uint64_t until) {
    while (player.counters().published < until)
      now = std::max(player.step(now), now);
  };
  play_volumes(2);
  const std::uint64_t before = tests::allocations_of_this_thread();
  play_volumes(20);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
  const Volume* volume = player.take_newest();
  ASSERT_NE(volume, nullptr);
  EXPECT_EQ(volume->levels, tests::small_recording_volume(19 % 8).levels);
  EXPECT_TRUE(faults.records().empty());
}

TEST(ReplayedFile, without_volumes_is_refused) {
  const tests::ScratchFolder folder;
  tests::write_small_recording(folder / "r.h5", 0);
  auto reader = tests::must(RecordingReader::open(folder / "r.h5"));
  EXPECT_THAT(replay_source(std::move(reader)), tests::FailsSaying("no volumes"));
}

// Cut off while it is replayed: what was lost is told, and what is left goes on.
TEST(ReplayedFile, that_is_cut_off_meanwhile_is_told) {
  const tests::ScratchFolder folder;
  tests::write_small_recording(folder / "r.h5", 8);
  auto reader = tests::must(RecordingReader::open(folder / "r.h5"));
  auto source = tests::must(replay_source(std::move(reader)));
  FaultLog faults;
  Wakeup news;
  ReplayPlayer player{std::move(source), {.once = true}, faults, news};
  hal::TimePoint now = start;
  while (player.counters().published < 2)
    now = std::max(player.step(now), now);
  std::filesystem::resize_file(folder / "r.h5", 2000);
  for (int i = 0; i < 1000 && player.end() == ReplayEnd::none; ++i)
    now = std::max(player.step(now), now);
  EXPECT_NE(player.end(), ReplayEnd::none);
  ASSERT_FALSE(faults.records().empty());
  EXPECT_EQ(faults.records()[0].kind, Fault::unreadable_volume);
}

} // namespace
} // namespace octascope::pipeline
