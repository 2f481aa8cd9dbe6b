// The recorder: what is offered is kept or counted, one recording after the other, on two threads.
#include <atomic>
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "pipeline/recordings/recorder.h"
#include "pipeline/recordings/recording_reader.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/small_recording.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using tests::small_recording_facts;
using tests::small_recording_volume;

class RecorderTest : public testing::Test {
protected:
  void begin(const std::filesystem::path& file) {
    ASSERT_TRUE(recorder.begin(file, small_recording_facts()));
    wait_until([&] { return recorder.status().on || !faults.records().empty(); });
  }
  void wait_until(const std::function<bool()>& done) {
    const auto deadline = clock.now() + 20s;
    bool is_done = done();
    while (!is_done && clock.now() < deadline) {
      std::this_thread::sleep_for(1ms);
      is_done = done();
    }
    ASSERT_TRUE(is_done);
  }
  // A recording was on just now.
  void end() {
    recorder.end();
    wait_until([&] { return recorder.begin(folder / "none/never.h5", {}); });
    wait_until([&] { return !faults.records().empty(); });
  }
  static std::vector<std::uint64_t> indices(const std::filesystem::path& file) {
    std::vector<std::uint64_t> all;
    const auto reader = RecordingReader::open(file);
    EXPECT_TRUE(reader) << reader.error().message;
    if (reader)
      for (const RecordedVolume& volume : reader->volumes())
        all.push_back(volume.index);
    return all;
  }

  tests::ScratchFolder folder;
  hal::linux_backend::MonotonicClock clock;
  FaultLog faults;
  Wakeup news;
  Recorder recorder{small_recording_facts().geometry, 4, clock, faults, news};
};

TEST_F(RecorderTest, keeps_what_comes_while_it_is_on) {
  recorder.start({});
  recorder.offer(small_recording_volume(0));
  begin(folder / "a.h5");
  for (std::uint64_t n = 1; n < 10; ++n) {
    recorder.offer(small_recording_volume(n));
    wait_until([&] { return recorder.status().kept == n; });
  }
  EXPECT_EQ(recorder.status().not_kept, 0U);
  end();
  recorder.offer(small_recording_volume(10));
  recorder.stop();

  auto reader = tests::must(RecordingReader::open(folder / "a.h5"));
  EXPECT_TRUE(reader.end().finished);
  ASSERT_EQ(reader.volumes().size(), 9U);
  Volume volume{small_recording_facts().geometry};
  for (std::uint64_t n = 1; n < 10; ++n) {
    ASSERT_TRUE(reader.read(n - 1, volume));
    EXPECT_EQ(volume.levels, small_recording_volume(n).levels);
    EXPECT_EQ(volume.b_scan_states, small_recording_volume(n).b_scan_states);
    EXPECT_EQ(reader.volumes()[n - 1].index, small_recording_volume(n).metadata.index);
  }
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto age = now - std::chrono::nanoseconds{reader.volumes().back().wall_clock_ns};
  EXPECT_LT(age, 60s);
  EXPECT_GT(age, 0s);
}

// The disk is slower than a thread that does nothing else: what finds no place is counted.
TEST_F(RecorderTest, keeps_or_counts_whatever_is_offered) {
  recorder.start({});
  begin(folder / "a.h5");
  const Volume volume = small_recording_volume(3);
  constexpr int offered = 5000;
  const auto before = tests::allocations_of_this_thread();
  for (int i = 0; i < offered; ++i)
    recorder.offer(volume);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
  recorder.stop();
  const RecorderStatus status = recorder.status();
  EXPECT_GE(status.kept, 4U);
  EXPECT_EQ(status.kept + status.not_kept, offered);
  const auto reader = tests::must(RecordingReader::open(folder / "a.h5"));
  EXPECT_EQ(reader.volumes().size(), status.kept);
  EXPECT_EQ(reader.end().not_kept, status.not_kept);
}

TEST_F(RecorderTest, makes_one_recording_after_the_other_and_mixes_none) {
  recorder.start({});
  std::atomic<bool> done{false};
  std::thread source{[&] {
    for (std::uint64_t n = 0; !done; ++n) {
      recorder.offer(small_recording_volume(n));
      std::this_thread::sleep_for(100us);
    }
  }};
  std::vector<std::vector<std::uint64_t>> all;
  for (int i = 0; i < 20; ++i) {
    const auto file = folder / ("r" + std::to_string(i) + ".h5");
    wait_until([&] { return recorder.begin(file, small_recording_facts()); });
    wait_until([&] { return recorder.status().on && recorder.status().kept > 2; });
    recorder.end();
    wait_until([&] { return !recorder.status().on; });
  }
  done = true;
  source.join();
  recorder.stop();
  std::uint64_t last = 0;
  for (int i = 0; i < 20; ++i) {
    for (const std::uint64_t index : indices(folder / ("r" + std::to_string(i) + ".h5"))) {
      EXPECT_GT(index, last) << "recording " << i;
      last = index;
    }
  }
}

TEST_F(RecorderTest, tells_what_cannot_be_begun_and_tries_again) {
  recorder.start({});
  begin(folder / "none/a.h5");
  ASSERT_EQ(faults.records().size(), 1U);
  EXPECT_EQ(faults.records()[0].kind, Fault::recording_not_begun);
  EXPECT_THAT(faults.records()[0].message, HasSubstr("none/a.h5"));
  EXPECT_FALSE(recorder.status().on);
  wait_until([&] { return recorder.begin(folder / "b.h5", small_recording_facts()); });
  wait_until([&] { return recorder.status().on; });
  recorder.stop();
  EXPECT_TRUE(RecordingReader::open(folder / "b.h5")->end().finished);
}

TEST_F(RecorderTest, ends_where_its_file_is_removed_and_says_why) {
  recorder.start({});
  begin(folder / "a.h5");
  recorder.offer(small_recording_volume(0));
  wait_until([&] { return recorder.status().kept == 1; });
  EXPECT_FALSE(recorder.failure());
  std::filesystem::remove(folder / "a.h5");
  wait_until([&] { return !recorder.status().on; });
  ASSERT_EQ(faults.records().size(), 1U);
  EXPECT_EQ(faults.records()[0].kind, Fault::recording_gone);
  EXPECT_EQ(tests::must(recorder.failure()).code, hal::ErrorCode::absent);
  wait_until([&] { return recorder.begin(folder / "b.h5", small_recording_facts()); });
  EXPECT_FALSE(recorder.failure()) << "of the new one";
  wait_until([&] { return recorder.status().on; });
  std::filesystem::remove(folder / "b.h5");
  recorder.stop(); // before it looked
  EXPECT_EQ(tests::must(recorder.failure()).code, hal::ErrorCode::absent);
}

TEST_F(RecorderTest, finishes_when_it_is_stopped) {
  recorder.start({});
  begin(folder / "a.h5");
  recorder.offer(small_recording_volume(0));
  recorder.stop();
  EXPECT_EQ(indices(folder / "a.h5").size(), 1U);
  EXPECT_TRUE(RecordingReader::open(folder / "a.h5")->end().finished);
}

TEST_F(RecorderTest, may_be_ended_before_it_has_begun) {
  recorder.start({});
  for (int i = 0; i < 50; ++i) {
    wait_until([&] {
      return recorder.begin(folder / ("r" + std::to_string(i) + ".h5"), small_recording_facts());
    });
    recorder.end();
  }
  recorder.offer(small_recording_volume(0));
  recorder.stop();
  EXPECT_TRUE(faults.records().empty());
  EXPECT_FALSE(recorder.status().on);
}

} // namespace
} // namespace octascope::pipeline
