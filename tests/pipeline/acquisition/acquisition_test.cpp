// What the camera thread makes of sequence numbers and broken frames.
#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "hal/linux/monotonic_clock.h"
#include "pipeline/acquisition/acquisition.h"
#include "tests/support/devices/fake_devices.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

class AcquisitionTest : public testing::Test {
protected:
  AcquisitionTest() {
    hal::LineCameraConfig config;
    config.format.samples_per_line = 16;
    config.format.lines_per_frame = 2;
    config.buffers = 8;
    acquisition_ = std::make_unique<Acquisition>(camera_, config, clock_, faults_, arrived_);
    EXPECT_TRUE(acquisition_->start({}));
    while (camera_.state() != hal::DeviceState::streaming)
      clock_.sleep_for(1ms);
  }

  // One frame for each number, each taken before the next comes.
  void deliver(std::initializer_list<std::uint64_t> sequences) {
    for (const std::uint64_t sequence : sequences) {
      camera_.deliver(sequence, clock_.now(), 0);
      for (auto frame = acquisition_->take();; frame = acquisition_->take()) {
        if (frame) {
          EXPECT_EQ(frame->sequence, sequence);
          acquisition_->release(frame->buffer);
          break;
        }
        arrived_.wait_until(clock_, clock_.now() + 1ms);
      }
    }
  }

  std::uint64_t count_of(Fault kind) const {
    const auto records = faults_.records();
    const auto found = std::ranges::find(records, kind, &FaultRecord::kind);
    return found == records.end() ? 0 : found->count;
  }

  hal::linux_backend::MonotonicClock clock_;
  tests::FakeCamera camera_;
  FaultLog faults_;
  Wakeup arrived_;
  std::unique_ptr<Acquisition> acquisition_;
};

TEST_F(AcquisitionTest, numbers_in_a_row_are_no_fault) {
  deliver({0, 1, 2, 3, 4});
  EXPECT_EQ(acquisition_->counters().frames, 5U);
  EXPECT_TRUE(faults_.records().empty());
}

TEST_F(AcquisitionTest, a_stream_may_begin_with_any_number) {
  deliver({1000, 1001});
  EXPECT_TRUE(faults_.records().empty());
}

TEST_F(AcquisitionTest, every_frame_of_a_gap_is_counted) {
  deliver({0, 1, 12, 13, 15});
  EXPECT_EQ(acquisition_->counters().gaps, 11U);
  EXPECT_EQ(count_of(Fault::dropped_frames), 11U);
  EXPECT_EQ(count_of(Fault::stuck_sequence), 0U);
}

TEST_F(AcquisitionTest, a_counter_that_hung_leaves_no_gap) {
  deliver({0, 1, 1, 1, 1, 5, 6});
  EXPECT_EQ(count_of(Fault::stuck_sequence), 3U);
  EXPECT_EQ(count_of(Fault::dropped_frames), 0U);
  EXPECT_EQ(acquisition_->counters().gaps, 0U);
}

TEST_F(AcquisitionTest, what_was_lost_while_it_hung_is_a_gap) {
  deliver({0, 1, 1, 5});
  EXPECT_EQ(count_of(Fault::stuck_sequence), 1U);
  EXPECT_EQ(count_of(Fault::dropped_frames), 2U);
}

TEST_F(AcquisitionTest, a_counter_that_begins_anew_is_told_once) {
  deliver({7, 8, 0, 1, 2});
  EXPECT_EQ(count_of(Fault::stuck_sequence), 1U);
  EXPECT_EQ(count_of(Fault::dropped_frames), 0U);
}

TEST_F(AcquisitionTest, what_the_camera_gave_is_queued_before_it_counts_as_looked_at) {
  for (std::uint64_t sequence = 0; sequence < 200; ++sequence) {
    const hal::TimePoint exposed = clock_.now();
    camera_.deliver(sequence, exposed, 0);
    while (acquisition_->looked_until() < exposed)
      clock_.sleep_for(100us);
    const auto frame = acquisition_->take();
    ASSERT_TRUE(frame) << "number " << sequence;
    acquisition_->release(frame->buffer);
  }
}

TEST_F(AcquisitionTest, a_look_that_was_asked_for_is_told_once) {
  const hal::TimePoint later = clock_.now() + 30ms;
  acquisition_->ask_for_look(later);
  ASSERT_TRUE(arrived_.wait_until(clock_, clock_.now() + 10s));
  EXPECT_GE(acquisition_->looked_until(), later);
  EXPECT_FALSE(arrived_.wait_until(clock_, clock_.now() + 100ms)) << "nobody asked for more";
}

TEST_F(AcquisitionTest, a_camera_that_has_nothing_is_looked_at_and_one_that_hangs_is_not) {
  acquisition_->ask_for_look(clock_.now());
  ASSERT_TRUE(arrived_.wait_until(clock_, clock_.now() + 10s));
  camera_.hold();
  camera_.wait_until_held();
  const hal::TimePoint held = acquisition_->looked_until();
  acquisition_->ask_for_look(clock_.now());
  EXPECT_FALSE(arrived_.wait_until(clock_, clock_.now() + 50ms));
  EXPECT_EQ(acquisition_->looked_until(), held);
  camera_.let_go();
  EXPECT_TRUE(arrived_.wait_until(clock_, clock_.now() + 10s));
  EXPECT_GT(acquisition_->looked_until(), held);
}

TEST_F(AcquisitionTest, a_silent_stream_is_opened_anew_while_the_scanner_is_pulsed) {
  deliver({0, 1});
  const hal::TimePoint begin = clock_.now();
  while (camera_.opened() == 1 && clock_.now() < begin + 20s) {
    acquisition_->note_unanswered_pulse();
    clock_.sleep_for(20ms);
  }
  EXPECT_EQ(camera_.opened(), 2);
  EXPECT_GE(clock_.now() - begin, 3s);
  EXPECT_EQ(count_of(Fault::silent), 1U);
  while (camera_.state() != hal::DeviceState::streaming)
    clock_.sleep_for(1ms);
  deliver({0, 1}); // and it serves again, with numbers of its own
  EXPECT_EQ(count_of(Fault::stuck_sequence), 0U);
}

TEST_F(AcquisitionTest, a_camera_that_nobody_triggers_may_be_silent) {
  deliver({0, 1});
  clock_.sleep_for(3500ms);
  EXPECT_EQ(camera_.opened(), 1);
  EXPECT_TRUE(faults_.records().empty());
}

TEST_F(AcquisitionTest, stamps_of_no_use_are_told_once_a_second_while_they_are) {
  deliver({0, 1});
  EXPECT_TRUE(faults_.records().empty());
  camera_.time_by_host(true);
  const hal::TimePoint begin = clock_.now();
  std::uint64_t next = 2;
  for (; count_of(Fault::unusable_stamps) < 3; ++next) {
    deliver({next});
    clock_.sleep_for(10ms);
  }
  EXPECT_GE(clock_.now() - begin, 2s);
  camera_.time_by_host(false);
  deliver({next, next + 1});
  EXPECT_EQ(count_of(Fault::unusable_stamps), 3U);
  camera_.time_by_host(true);
  deliver({next + 2});
  EXPECT_EQ(count_of(Fault::unusable_stamps), 4U) << "at once";
}

// A frame every 0.1 ms.
class AcquisitionOfManyFrames : public testing::Test {
protected:
  AcquisitionOfManyFrames() {
    EXPECT_TRUE(acquisition_.start({}));
    while (camera_.state() != hal::DeviceState::streaming)
      clock_.sleep_for(1ms);
  }

  static hal::LineCameraConfig config() {
    hal::LineCameraConfig config;
    config.format = {.samples_per_line = 16, .lines_per_frame = 20};
    config.line_rate_hz = 200e3;
    config.buffers = 128;
    return config;
  }

  void take_those_there() {
    while (const auto frame = acquisition_.take()) {
      EXPECT_EQ(frame->sequence, taken_++);
      acquisition_.release(frame->buffer);
    }
  }

  hal::linux_backend::MonotonicClock clock_;
  tests::FakeCamera camera_;
  FaultLog faults_;
  Wakeup arrived_;
  Acquisition acquisition_{camera_, config(), clock_, faults_, arrived_};
  std::uint64_t taken_ = 0;
};

TEST_F(AcquisitionOfManyFrames, are_told_of_several_at_a_time) {
  const hal::TimePoint begin = clock_.now();
  std::uint64_t delivered = 0;
  std::int64_t told = 0;
  while (taken_ < 500) {
    if (delivered < 500)
      camera_.deliver(delivered++, clock_.now(), 0);
    told += arrived_.wait_until(clock_, clock_.now() + 100us) ? 1 : 0;
    take_those_there();
    ASSERT_LT(clock_.now(), begin + 60s);
  }
  EXPECT_LE(told, (clock_.now() - begin) / 1ms + 2);
  EXPECT_TRUE(faults_.records().empty());
}

// They would be given the times at which they were fetched, all the same.
TEST_F(AcquisitionOfManyFrames, are_told_of_one_by_one_where_the_host_times_them) {
  camera_.time_by_host(true);
  camera_.deliver(0, clock_.now(), 0);
  for (; taken_ < 1; take_those_there())
    arrived_.wait_until(clock_, clock_.now() + 1ms);
  clock_.sleep_for(20ms); // it was gathered
  arrived_.wait_until(clock_, clock_.now());
  for (std::uint64_t sequence = 1; sequence <= 20; ++sequence)
    camera_.deliver(sequence, clock_.now(), 0);
  for (; taken_ < 21; take_those_there())
    clock_.sleep_for(1ms);
  for (int frame = 1; frame <= 20; ++frame)
    arrived_.wait(); // for ever, if one is missing
}

TEST(AcquisitionStart, a_camera_that_is_long_in_starting_is_waited_for_and_not_opened_anew) {
  tests::FakeCamera camera;
  camera.start_late(2);
  hal::linux_backend::MonotonicClock clock;
  FaultLog faults;
  Wakeup arrived;
  Acquisition acquisition{camera,
                          {.format = {.samples_per_line = 16, .lines_per_frame = 2}, .buffers = 8},
                          clock,
                          faults,
                          arrived};
  ASSERT_TRUE(acquisition.start({}));
  while (camera.state() != hal::DeviceState::streaming)
    clock.sleep_for(1ms);
  EXPECT_EQ(camera.opened(), 1);
  acquisition.stop();
  ASSERT_EQ(faults.records().size(), 1U);
  EXPECT_EQ(faults.records()[0].kind, fault_of(Device::line_camera, hal::ErrorCode::absent));
}

} // namespace
} // namespace octascope::pipeline
