// The recorder of raw spectra: what workers offer is kept or counted.
#include <chrono>
#include <optional>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "hal/semaphore.h"
#include "pipeline/recordings/raw/raw_reader.h"
#include "pipeline/recordings/raw/raw_recorder.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/files/small_raw.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class RawRecorderTest : public testing::Test {
protected:
  static constexpr std::size_t workers = 2;

  std::unique_ptr<RawRecorder> recorder(std::uint64_t most_frames = 0,
                                        RawFacts facts = tests::small_raw_facts()) {
    return std::make_unique<RawRecorder>(file, std::move(facts), workers, most_frames, clock,
                                         faults);
  }
  static void offer(RawRecorder& recorder, std::size_t worker, std::uint64_t n) {
    const std::vector<std::uint16_t> samples = tests::small_raw_samples(n);
    recorder.offer(worker, tests::small_raw_frame(n), std::as_bytes(std::span{samples}),
                   tests::small_raw_background(n));
  }
  template <class Done> void wait_until(const Done& done) {
    const auto deadline = clock.now() + 20s;
    while (!done() && clock.now() < deadline)
      std::this_thread::sleep_for(1ms);
    ASSERT_TRUE(done());
  }

  tests::ScratchFolder folder;
  std::filesystem::path file = folder / "raw.h5";
  hal::linux_backend::MonotonicClock clock;
  FaultLog faults;
};

TEST_F(RawRecorderTest, keeps_what_two_workers_offer) {
  const auto raw = recorder();
  ASSERT_TRUE(raw->start({}));
  constexpr std::uint64_t each = 500;
  std::vector<std::thread> threads;
  for (std::size_t worker = 0; worker < workers; ++worker)
    threads.emplace_back([&, worker] {
      for (std::uint64_t n = 0; n < each; ++n)
        offer(*raw, worker, n * workers + worker);
    });
  for (std::thread& thread : threads)
    thread.join();
  raw->stop("that camera");
  EXPECT_FALSE(raw->failure());
  EXPECT_EQ(raw->status().offered, each * workers);
  EXPECT_EQ(raw->status().kept, each * workers); // there are slots for all of them
  const auto reader = tests::must(RawReader::open(file));
  EXPECT_TRUE(reader.end().finished);
  EXPECT_EQ(reader.end().camera, "that camera");
  ASSERT_EQ(reader.frames().size(), each * workers);
  for (std::uint64_t n = 0; n < reader.frames().size(); ++n)
    ASSERT_EQ(reader.frames()[n].sequence, n);
  const auto spectra = tests::must(reader.spectra(0, 40, RawLines::all));
  for (int b = 0; b < 40; ++b)
    EXPECT_EQ(spectra.find_fault(b), std::nullopt);
}

// The disk is slower than a thread that does nothing else: what finds no slot is counted.
TEST_F(RawRecorderTest, keeps_or_counts_whatever_is_offered_and_allocates_nothing) {
  RawFacts large = tests::small_raw_facts();
  large.plan.fly_back_lines = 60'000; // 2 MB a frame: 139 slots
  large.format.lines_per_frame = large.plan.lines_per_frame();
  const auto raw = recorder(0, large);
  ASSERT_TRUE(raw->start({}));
  const std::vector<std::byte> frame(large.format.frame_bytes());
  const auto background = tests::small_raw_background(0);
  constexpr std::uint64_t offered = 3000;
  const auto before = tests::allocations_of_this_thread();
  for (std::uint64_t n = 0; n < offered; ++n)
    raw->offer(n % workers, {}, n < 200 ? frame : std::span{frame}.first(2), background);
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
  raw->stop("");
  const RawRecorderStatus status = raw->status();
  EXPECT_EQ(status.offered, offered);
  EXPECT_EQ(status.kept + status.not_kept, offered);
  EXPECT_GT(status.not_kept, 0U);
  const auto reader = tests::must(RawReader::open(file));
  EXPECT_EQ(reader.frames().size(), status.kept);
  EXPECT_EQ(reader.end().not_kept, status.not_kept);
}

TEST_F(RawRecorderTest, takes_as_many_as_were_asked_for) {
  const auto raw = recorder(7);
  ASSERT_TRUE(raw->start({}));
  for (std::uint64_t n = 0; n < 100; ++n)
    offer(*raw, 0, n);
  raw->stop("");
  EXPECT_EQ(raw->status().kept, 7U);
  EXPECT_EQ(raw->status().offered, 7U);
  EXPECT_EQ(tests::must(RawReader::open(file)).frames().size(), 7U);
}

TEST_F(RawRecorderTest, begins_nothing_where_it_cannot) {
  folder.write("raw.h5", "mine");
  const auto over = recorder();
  const auto begun = over->start({});
  ASSERT_FALSE(begun);
  EXPECT_THAT(begun.error().message, HasSubstr("never written over"));
  over->stop("");
  file = folder / "none/raw.h5";
  EXPECT_THAT(recorder()->start({}).error().message, HasSubstr("none/raw.h5"));
}

// A disk that does not answer until it is let go.
class HangingDisk {
public:
  RawWriterMaker maker(std::optional<hal::Error> answer = {}) {
    return [this, answer](const std::filesystem::path& file,
                          const RawFacts& facts) -> hal::Result<RawWriter> {
      answers_.wait();
      if (answer)
        return tl::make_unexpected(*answer);
      return RawWriter::create(file, facts);
    };
  }
  void answer() { answers_.post(); }

private:
  hal::Semaphore answers_;
};

// Declared after the recorder that waits for the disk: where a test ends early, too, it is let go.
struct AnswerAtEnd {
  HangingDisk& disk;
  ~AnswerAtEnd() { disk.answer(); }
};

TEST_F(RawRecorderTest, waits_for_its_disk_without_holding_up_the_start_and_counts_what_comes) {
  HangingDisk disk;
  RawRecorder raw{file, tests::small_raw_facts(), workers, 0, clock, faults, disk.maker()};
  const AnswerAtEnd at_end{disk};
  ASSERT_TRUE(raw.start({}));
  EXPECT_TRUE(raw.status().waiting);
  EXPECT_FALSE(raw.status().on);
  ASSERT_FALSE(faults.records().empty());
  EXPECT_EQ(faults.records()[0].kind, Fault::recording_waits);
  EXPECT_FALSE(raw.status().made);
  wait_until([&] { return faults.records()[0].count > 1; }); // told as long as it lasts
  offer(raw, 0, 0);
  EXPECT_EQ(raw.status().not_kept, 1U);
  disk.answer();
  wait_until([&] { return raw.status().on; });
  EXPECT_FALSE(raw.status().waiting);
  EXPECT_TRUE(raw.status().made);
  offer(raw, 1, 1);
  raw.stop("");
  EXPECT_FALSE(raw.failure());
  const auto reader = tests::must(RawReader::open(file));
  ASSERT_EQ(reader.frames().size(), 1U);
  EXPECT_EQ(reader.frames()[0].sequence, 1U);
  EXPECT_EQ(reader.end().not_kept, 1U);
}

TEST_F(RawRecorderTest, ends_where_its_disk_answers_late_that_it_cannot) {
  HangingDisk disk;
  RawRecorder raw{file,
                  tests::small_raw_facts(),
                  workers,
                  0,
                  clock,
                  faults,
                  disk.maker(hal::Error{hal::ErrorCode::system, "the disk is broken"})};
  const AnswerAtEnd at_end{disk};
  ASSERT_TRUE(raw.start({}));
  disk.answer();
  wait_until([&] { return raw.failure().has_value(); });
  offer(raw, 0, 0);
  raw.stop("");
  EXPECT_EQ(raw.failure()->message, "the disk is broken");
  EXPECT_FALSE(raw.status().made);
  EXPECT_EQ(raw.status().not_kept, 1U);
  EXPECT_FALSE(raw.status().on);
  ASSERT_EQ(faults.records().size(), 2U);
  EXPECT_EQ(faults.records()[1].kind, Fault::recording_not_begun);
}

// More could be written, and nobody could read it.
TEST_F(RawRecorderTest, refuses_frames_that_no_reader_takes) {
  RawFacts long_frames = tests::small_raw_facts();
  long_frames.plan.fly_back_lines = 65536;
  long_frames.format.lines_per_frame = long_frames.plan.lines_per_frame();
  const auto begun = recorder(0, long_frames)->start({});
  ASSERT_FALSE(begun);
  EXPECT_THAT(begun.error().message, HasSubstr("expected at most 65536"));
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(RawRecorderTest, ends_where_its_file_is_removed_and_says_why) {
  const auto raw = recorder();
  ASSERT_TRUE(raw->start({}));
  offer(*raw, 0, 0);
  wait_until([&] { return raw->status().kept == 1; });
  std::filesystem::remove(file);
  wait_until([&] { return raw->failure().has_value(); });
  offer(*raw, 0, 1);
  raw->stop("");
  EXPECT_EQ(raw->failure()->code, hal::ErrorCode::absent);
  EXPECT_THAT(raw->failure()->message, HasSubstr("is lost"));
  ASSERT_FALSE(faults.records().empty());
  EXPECT_EQ(faults.records()[0].kind, Fault::recording_gone);
  EXPECT_EQ(raw->status().kept + raw->status().not_kept, raw->status().offered);
}

} // namespace
} // namespace octascope::pipeline
