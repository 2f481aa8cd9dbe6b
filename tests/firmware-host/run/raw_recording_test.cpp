// What the screen says of raw spectra that are being kept.
#include <gtest/gtest.h>

#include "firmware-host/outputs/run_recorder.h"
#include "firmware-host/run/raw_recording.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint began{100s};

pipeline::RawRecorderStatus keeping() {
  return {.on = true, .since = began, .offered = 540, .kept = 500, .not_kept = 40, .room = 1000};
}

TEST(RawRecordingStatus, says_that_one_is_on_how_long_and_what_was_not_kept) {
  ui::RecordingStatus status;
  add_raw(status, keeping(), began + 5s);
  EXPECT_TRUE(status.on);
  EXPECT_EQ(status.lasted, 5s);
  EXPECT_EQ(status.not_kept, 40U);
  EXPECT_EQ(status.room, 10s); // a hundred frames a second
}

TEST(RawRecordingStatus, beside_levels_is_of_both) {
  ui::RecordingStatus status{.on = true, .lasted = 4s, .not_kept = 2, .room = 7s};
  add_raw(status, keeping(), began + 5s);
  EXPECT_EQ(status, (ui::RecordingStatus{.on = true, .lasted = 5s, .not_kept = 42, .room = 7s}));
  status.room = 3600s;
  add_raw(status, keeping(), began + 5s);
  EXPECT_EQ(status.room, 10s);
}

TEST(RawRecordingStatus, of_one_that_has_ended_is_nothing) {
  ui::RecordingStatus status;
  pipeline::RawRecorderStatus ended = keeping();
  ended.on = false;
  add_raw(status, ended, began + 5s);
  EXPECT_EQ(status, ui::RecordingStatus{});
}

TEST(RawRecordingStatus, knows_no_room_before_anything_was_kept_and_does_not_overflow) {
  EXPECT_EQ(time_left(5s, 0, 10), std::nullopt);
  EXPECT_EQ(time_left(5s, 10, std::nullopt), std::nullopt);
  EXPECT_GT(time_left(3600s, 1, UINT64_MAX), 24h * 365);
}

} // namespace
} // namespace octascope::firmware_host
