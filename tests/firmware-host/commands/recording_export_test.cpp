// What export and info are made of: ranges of volumes, names of files, sizes, room on the disk,
// gaps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/level_picture.h"
#include "firmware-host/commands/recordings/export_place.h"
#include "firmware-host/commands/recordings/recording_summary.h"
#include "firmware-host/commands/size_text.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"

namespace octascope::firmware_host {
namespace {

using pipeline::RecordedVolume;
using testing::HasSubstr;

TEST(VolumeRanges, are_one_volume_or_from_to_or_from) {
  EXPECT_EQ(parse_volumes("12")->first, 12U);
  EXPECT_EQ(parse_volumes("12")->last, 12U);
  EXPECT_EQ(parse_volumes("3-7")->first, 3U);
  EXPECT_EQ(parse_volumes("3-7")->last, 7U);
  EXPECT_EQ(parse_volumes("3-")->first, 3U);
  EXPECT_EQ(parse_volumes("3-")->last, std::nullopt);
  for (const char* wrong : {"", "-", "-3", "a", "3-a", "7-3", "3-7-9", "3 -7", "3,7", "+3",
                            "3-99999999999999999999", "3.5"})
    EXPECT_FALSE(parse_volumes(wrong)) << wrong;
}

TEST(Sizes, are_megabytes_up_to_a_gigabyte) {
  EXPECT_EQ(size_words(0), "0.0 MB");
  EXPECT_EQ(size_words(69'840'000), "69.8 MB");
  EXPECT_EQ(size_words(999'600'000), "999.6 MB");
  EXPECT_EQ(size_words(4'213'000'000), "4.21 GB");
}

TEST(ExportPlaces, are_a_file_for_one_volume_and_a_folder_for_several) {
  const tests::ScratchFolder folder;
  const auto one = tests::must(ExportPlace::choose(folder / "a.dcm", ".dcm", "-x", 1));
  EXPECT_EQ(one.file_of(17), folder / "a.dcm");
  const auto several = tests::must(ExportPlace::choose(folder / "a", ".dcm", "-x", 20));
  EXPECT_EQ(several.file_of(17), folder / "a/volume-0017-x.dcm");
  EXPECT_EQ(several.file_of(12345), folder / "a/volume-12345-x.dcm");
  // Nothing is made before prepare().
  EXPECT_EQ(folder.count(), 0);
  EXPECT_EQ(ExportPlace::choose(folder / "a.dcm", ".dcm", "", 2).error().code,
            hal::ErrorCode::invalid_argument);
}

TEST(ExportPlaces, are_refused_before_the_work) {
  if (geteuid() == 0)
    GTEST_SKIP() << "root may write anywhere";
  const tests::ScratchFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read |
                                                  std::filesystem::perms::owner_exec);
  auto inside = tests::must(ExportPlace::choose(folder / "a", ".dcm", "", 2));
  EXPECT_EQ(inside.prepare(1, 0).error().code, hal::ErrorCode::denied);
  auto file = tests::must(ExportPlace::choose(folder / "a.dcm", ".dcm", "", 1));
  EXPECT_EQ(file.prepare(1, 0).error().code, hal::ErrorCode::denied);
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

TEST(ExportPlaces, without_room_are_refused_and_leave_nothing) {
  const tests::ScratchFolder folder;
  auto place = tests::must(ExportPlace::choose(folder / "a", ".nrrd", "", 2));
  EXPECT_THAT(place.prepare(std::uint64_t{1} << 62, 0),
              tests::FailsSaying("expected 4611686018.43 GB for the files"));
  place.remove_empty_folder();
  EXPECT_EQ(folder.count(), 0);
  EXPECT_TRUE(place.prepare(1, 0));
  EXPECT_EQ(check_room("d", 5'000'000, 4'999'999).error().message,
            "d: found 5.0 MB free, expected 5.0 MB for the files; fewer volumes (--volumes) or "
            "another disk");
  EXPECT_TRUE(check_room("d", 5, 5));
}

TEST(RecordingSummaries, find_gaps_and_sum_what_was_lost) {
  std::vector<RecordedVolume> volumes;
  for (const std::uint64_t index : {5U, 6U, 9U, 10U, 20U}) {
    RecordedVolume volume;
    volume.index = index;
    volume.first_line_ns = static_cast<std::int64_t>(index) * 100'000'000;
    volume.lost_b_scans = 1;
    volume.lost_lines = 10;
    volume.saturated_lines = 100;
    volumes.push_back(volume);
  }
  const RecordingSummary found = summarise(volumes, 0.1);
  EXPECT_EQ(found.volumes, 5U);
  EXPECT_EQ(found.first_index, 5U);
  EXPECT_EQ(found.last_index, 20U);
  EXPECT_EQ(found.gaps, 2U);
  EXPECT_EQ(found.volumes_in_gaps, 2U + 9U);
  EXPECT_EQ(found.longest_gap, 9U);
  EXPECT_EQ(found.lost_b_scans, 5);
  EXPECT_EQ(found.lost_lines, 50);
  EXPECT_EQ(found.saturated_lines, 500);
  EXPECT_NEAR(found.duration_s, 1.6, 1e-12);
  EXPECT_NEAR(found.rate_hz.value_or(0), 4 / 1.5, 1e-12);
  EXPECT_EQ(summarise({}, 0.1).volumes, 0U);
  EXPECT_FALSE(summarise(std::span{volumes}.first(1), 0.1).rate_hz);
  std::ranges::reverse(volumes); // what a damaged file may say
  EXPECT_EQ(summarise(volumes, 0.1).gaps, 0U);
}

// Older recordings give an index to what was triggered alone. A tick that was held up for less than a
// period lost nothing.
TEST(RecordingSummaries, tell_a_pause_by_the_index_or_by_the_times) {
  using Times = std::vector<std::pair<std::uint64_t, double>>; // index and planned periods
  const auto lost = [](const Times& times) {
    std::vector<RecordedVolume> volumes;
    for (const auto& [index, periods] : times)
      volumes.push_back(
          {.index = index, .first_line_ns = static_cast<std::int64_t>(periods * 100'000'000)});
    return summarise(volumes, 0.1).volumes_in_gaps;
  };
  EXPECT_EQ(lost({{1, 0}, {2, 1}, {3, 22.02}, {4, 23}}), 20U);
  EXPECT_EQ(lost({{1, 0}, {2, 1}, {23, 22.02}, {24, 23}}), 20U);
  EXPECT_EQ(lost({{1, 0}, {2, 1}, {23, 22.99}, {24, 23}}), 20U);
  EXPECT_EQ(lost({{1, 0}, {2, 1.99}, {3, 2}, {4, 3.9}}), 0U);
  EXPECT_EQ(lost({{1, 0}, {2, 9e10}}), 89'999'999'999U);
  EXPECT_EQ(lost({{1, 5}, {2, 0}}), 0U);
}

TEST(RecordingSummaries, tell_of_a_machine_that_slept_by_the_wall_clock) {
  std::vector<RecordedVolume> volumes;
  for (int n = 0; n < 4; ++n)
    volumes.push_back({.index = static_cast<std::uint64_t>(n + 1),
                       .first_line_ns = n * std::int64_t{100'000'000},
                       .published_ns = n * std::int64_t{100'000'000},
                       .wall_clock_ns = n * std::int64_t{101'000'000}});
  EXPECT_EQ(summarise(volumes, 0.1).pauses, 0U) << "a clock that is a little fast";
  volumes[2].wall_clock_ns += 3'500'000'000;
  volumes[3].wall_clock_ns += 3'500'000'000;
  const RecordingSummary found = summarise(volumes, 0.1);
  EXPECT_EQ(found.pauses, 1U);
  EXPECT_NEAR(found.paused_s, 3.5, 0.01);
  EXPECT_EQ(found.volumes_in_gaps, 0U) << "none was planned";
}

TEST(PicturesToScale, are_as_large_as_what_they_show) {
  pipeline::Image grey{10, 4, 1};
  for (std::size_t i = 0; i < grey.pixels.size(); ++i)
    grey.pixels[i] = static_cast<std::uint8_t>(i);
  const auto wider = tests::must(to_scale(grey, 30, 10));
  EXPECT_EQ(wider.width, 30);
  EXPECT_EQ(wider.height, 4);
  for (std::size_t i = 0; i < wider.pixels.size(); ++i)
    EXPECT_EQ(wider.pixels[i], grey.pixels[i / 3]);
  const auto higher = tests::must(to_scale(grey, 10, 25));
  EXPECT_EQ(higher.width, 10);
  EXPECT_EQ(higher.height, 10);
  EXPECT_EQ(to_scale(grey, 7, 7)->pixels, grey.pixels);
  EXPECT_FALSE(to_scale(grey, 1e6, 1));
}

} // namespace
} // namespace octascope::firmware_host
