// A replay on its own thread and the real clock, with its reader on another.
#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "pipeline/recordings/replay/replay_thread.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/small_recording.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

class ReplayThreadTest : public testing::Test {
protected:
  void SetUp() override { tests::write_small_recording(folder / "r.h5", 6); }

  std::unique_ptr<ReplayThread> make(const ReplaySetup& setup) {
    auto reader = RecordingReader::open(folder / "r.h5");
    EXPECT_TRUE(reader) << reader.error().message;
    auto source = replay_source(std::move(*reader));
    EXPECT_TRUE(source) << source.error().message;
    return std::make_unique<ReplayThread>(std::move(*source), setup, clock, faults, news);
  }
  // The next one that is published, within a time that no machine needs.
  const Volume* wait_for_volume(ReplayThread& thread) {
    const hal::TimePoint end = clock.now() + 30s;
    const Volume* volume = thread.take_newest();
    while (volume == nullptr && clock.now() < end) {
      news.wait_until(clock, clock.now() + 20ms);
      volume = thread.take_newest();
    }
    return volume;
  }

  tests::ScratchFolder folder;
  hal::linux_backend::MonotonicClock clock;
  FaultLog faults;
  Wakeup news;
};

TEST_F(ReplayThreadTest, publishes_whole_volumes_that_stay_as_they_are) {
  const auto thread = make({.rate = 20});
  const hal::TimePoint begin = clock.now();
  thread->start({});
  for (int i = 0; i < 20; ++i) {
    const Volume* volume = wait_for_volume(*thread);
    ASSERT_NE(volume, nullptr);
    const std::uint64_t index = volume->metadata.index;
    const Volume written = tests::small_recording_volume(index > 2 ? index - 2 : index - 1);
    EXPECT_EQ(volume->levels, written.levels);
    EXPECT_GE(volume->metadata.published, begin);
    EXPECT_LE(volume->metadata.published, clock.now());
  }
  thread->stop();
  EXPECT_TRUE(faults.records().empty());
}

TEST_F(ReplayThreadTest, ends_by_itself_with_all_volumes) {
  const auto thread = make({.rate = 20, .once = true});
  thread->start({});
  const hal::TimePoint end = clock.now() + 30s;
  while (thread->end() == ReplayEnd::none && clock.now() < end)
    news.wait_until(clock, clock.now() + 20ms);
  EXPECT_EQ(thread->end(), ReplayEnd::done);
  EXPECT_EQ(thread->counters().published, 6U);
  EXPECT_EQ(wait_for_volume(*thread)->metadata.index, 7U);
}

TEST_F(ReplayThreadTest, takes_a_request_at_once_although_it_sleeps) {
  const auto thread = make({.rate = 0.1}); // one volume in 1.4 s
  thread->start({});
  ASSERT_NE(wait_for_volume(*thread), nullptr);
  thread->seek(4);
  const Volume* volume = wait_for_volume(*thread);
  ASSERT_NE(volume, nullptr);
  EXPECT_EQ(volume->metadata.index, 6U);
  EXPECT_EQ(thread->position(), 4U);
}

TEST_F(ReplayThreadTest, ends_while_it_waits) {
  for (int i = 0; i < 20; ++i) {
    const auto thread = make({.rate = 0.1});
    thread->start({});
  }
}

} // namespace
} // namespace octascope::pipeline
