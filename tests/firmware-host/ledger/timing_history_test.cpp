// What the timing diagram is made from.
#include <chrono>
#include <set>

#include <gtest/gtest.h>

#include "firmware-host/ledger/timing_history.h"

namespace octascope::tests {
namespace {

using namespace firmware_host;
using std::chrono::milliseconds;

constexpr int b_scans = 4;

hal::TimePoint at(int ms) {
  return hal::TimePoint{milliseconds{ms}};
}

pipeline::Volume volume_from(int begin, std::uint64_t index) {
  pipeline::Volume volume;
  pipeline::VolumeMetadata& m = volume.metadata;
  m.index = index;
  m.first_line = at(begin);
  m.last_line = at(begin + 100);
  m.fetched = at(begin + 101);
  m.placed = at(begin + 103);
  m.built = at(begin + 106);
  m.published = at(begin + 108);
  m.assemble = milliseconds{2};
  for (int b = 0; b < b_scans; ++b)
    volume.work.push_back({.begin = at(begin + 25 * b),
                           .end = b == 2 ? hal::TimePoint{} : at(begin + 25 * b + 5),
                           .worker = static_cast<std::uint32_t>(b % 2)});
  return volume;
}

Showing showing_from(int begin) {
  return {at(begin + 110), at(begin + 114), at(begin + 130), at(begin + 140)};
}

TEST(TimingHistory, keeps_the_last_three_from_the_first_line_to_the_glass) {
  TimingHistory history{b_scans};
  for (std::uint64_t i = 1; i <= 5; ++i)
    history.add(volume_from(static_cast<int>(i) * 1000, i),
                showing_from(static_cast<int>(i) * 1000));
  const ui::Timing& timing = history.timing();
  EXPECT_EQ(timing.newest, 5U);
  EXPECT_EQ(timing.newest_volume().index, 5U);
  EXPECT_EQ(timing.workers, 2U);
  std::set<std::uint64_t> kept;
  for (const ui::TimedVolume& volume : timing.volumes) {
    kept.insert(volume.index);
    hal::Duration from_last_line{};
    for (const ui::TimingBar& bar : volume.bars)
      if (bar.row != ui::TimingRow::exposure && bar.row != ui::TimingRow::workers)
        from_last_line += bar.end - bar.begin;
    // Between the frame's place and the volume's assembly the workers have it, here for 3 ms.
    EXPECT_EQ(from_last_line + milliseconds{3}, volume.flipped - volume.last_line);
    EXPECT_EQ(std::ranges::count(volume.bars, ui::TimingRow::workers, &ui::TimingBar::row), 3)
        << "the missing one has none";
  }
  EXPECT_EQ(kept, (std::set<std::uint64_t>{3, 4, 5}));
}

} // namespace
} // namespace octascope::tests
