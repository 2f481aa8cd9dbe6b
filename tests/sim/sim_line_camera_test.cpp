// What the line camera's twin does beyond the contract: times, faults, motion, cost.
#include <ctime>

#include <gtest/gtest.h>

#include "sim/devices/sim_galvo_trigger.h"
#include "sim/devices/sim_line_camera.h"
#include "tests/sim/twin_support.h"
#include "tests/support/fails_with.h"

namespace octascope::sim {
namespace {

using hal::FrameIntegrity;
using hal::TimePoint;
using namespace std::chrono_literals;
using tests::FailsSaying;
using tests::FailsWith;

constexpr int b_scans = 6;
constexpr int lines = 8;
constexpr int samples = 32;
constexpr hal::Duration frame_period = 2ms;

class SimLineCameraTest : public testing::Test {
protected:
  // One sweep of a fresh camera under a fault script, everything released at once.
  std::vector<hal::LineFrame> sweep(const std::string& faults, ScanMotion motion = {}) {
    schedule_ = std::make_unique<FaultSchedule>(script_of(faults));
    schedule_->start(clock_.now());
    camera_ = std::make_unique<SimLineCamera>(*source_, link_, clock_, schedule_.get(), motion);
    EXPECT_TRUE(camera_->open({.format = source_->format(), .line_rate_hz = 4e3, .buffers = 16}));
    EXPECT_TRUE(camera_->start());
    triggered_ = clock_.now();
    link_.pulse(triggered_);
    return fetch_all();
  }

  std::vector<hal::LineFrame> fetch_all() {
    std::vector<hal::LineFrame> frames;
    while (const auto frame = *camera_->wait_frame(100ms)) {
      frames.push_back(*frame);
      handed_out_.push_back(clock_.now());
    }
    return frames;
  }

  static std::string on_camera(const std::string& text) {
    return "[[fault]]\ndevice = \"line_camera\"\nat_s = 0\n" + text + "\n";
  }

  static std::uint16_t sample(const hal::LineFrame& frame, int line, int n) {
    const auto at = static_cast<std::size_t>(2 * (line * samples + n));
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(frame.bytes[at]) |
                                      std::to_integer<unsigned>(frame.bytes[at + 1]) << 8U);
  }

  VirtualClock clock_;
  std::unique_ptr<RecordedSpectra> source_ = numbered_spectra(b_scans, lines, samples);
  GalvoLink link_{b_scans * frame_period};
  std::unique_ptr<FaultSchedule> schedule_;
  std::unique_ptr<SimLineCamera> camera_;
  TimePoint triggered_;
  std::vector<TimePoint> handed_out_;
};

TEST_F(SimLineCameraTest, times_are_those_of_the_line_clock_and_bytes_are_the_source_s) {
  const auto frames = sweep("");
  ASSERT_EQ(frames.size(), 6U);
  for (int f = 0; f < b_scans; ++f) {
    const auto i = static_cast<std::size_t>(f);
    EXPECT_EQ(frames[i].first_line, triggered_ + f * frame_period);
    EXPECT_EQ(frames[i].last_line, triggered_ + (f + 1) * frame_period - 250us);
    EXPECT_EQ(handed_out_[i], triggered_ + (f + 1) * frame_period);
    EXPECT_EQ(frames[i].bytes.data(), source_->frame(0, f).data()) << "no copy";
  }
}

TEST_F(SimLineCameraTest, a_latched_sweep_follows_without_a_gap) {
  sweep("");
  link_.pulse(clock_.now());
  link_.pulse(clock_.now());
  const auto frames = fetch_all();
  ASSERT_EQ(frames.size(), 10U) << "16 buffers, 6 of them on loan";
  EXPECT_EQ(frames[6].first_line, frames[5].last_line + 250us);
}

TEST_F(SimLineCameraTest, started_in_the_middle_of_a_sweep_it_begins_with_the_next_b_scan) {
  sweep("");
  camera_->stop();
  link_.pulse(clock_.now());
  clock_.advance(3ms); // in the middle of B-scan 1
  ASSERT_TRUE(camera_->start());
  const auto frames = fetch_all();
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[0].sequence, 0U);
  EXPECT_EQ(frames[0].bytes.data(), source_->frame(0, 2).data());
}

TEST_F(SimLineCameraTest, an_endless_nap_of_the_reader_is_a_gap) {
  sweep("");
  for (int i = 0; i < 200; ++i) {
    clock_.advance(12ms);
    link_.pulse(clock_.now());
  }
  const auto frames = fetch_all();
  ASSERT_EQ(frames.size(), 10U);
  EXPECT_EQ(camera_->tally().made, 6U + 200U * 6U);
  EXPECT_EQ(camera_->tally().dropped_without_buffer, 200U * 6U - 10U);
  EXPECT_EQ(camera_->tally().delivered, 16U);
}

TEST_F(SimLineCameraTest, refuses_a_plan_that_is_not_the_scanner_s) {
  SimLineCamera camera{*source_, link_, clock_};
  EXPECT_THAT(camera.open({.format = source_->format(), .line_rate_hz = 5e3, .buffers = 4}),
              FailsSaying("take 0.0096 s, expected the 0.012 s"));
}

TEST_F(SimLineCameraTest, dropped_frames_leave_a_gap) {
  const auto frames = sweep(on_camera("kind = \"dropped_frames\"\nduration_s = 10\nevery = 3"));
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[2].sequence, 3U);
  EXPECT_EQ(frames[3].sequence, 4U);
  EXPECT_EQ(camera_->tally().dropped_by_fault, 2U);
  EXPECT_EQ(camera_->tally().made, 6U);
}

TEST_F(SimLineCameraTest, corrupted_frames_are_flagged_and_scrambled) {
  const auto frames = sweep(on_camera("kind = \"corrupted_frames\"\ncount = 1"));
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_EQ(frames[0].integrity, FrameIntegrity::corrupted);
  const auto good = source_->frame(0, 0);
  ASSERT_EQ(frames[0].bytes.size(), good.size());
  EXPECT_FALSE(std::equal(good.begin(), good.end(), frames[0].bytes.begin()));
  EXPECT_EQ(frames[1].integrity, FrameIntegrity::good);
  EXPECT_EQ(frames[1].bytes.data(), source_->frame(0, 1).data());
  EXPECT_EQ(camera_->tally().altered, 1U);
}

TEST_F(SimLineCameraTest, wrong_sizes_are_short_or_long) {
  const std::size_t right = source_->format().frame_bytes();
  for (const auto& [share, size] : {std::pair{"0.5", right / 2}, {"2", right * 2}, {"0", 0}}) {
    const auto frames =
        sweep(on_camera("kind = \"wrong_size\"\ncount = 1\nsize_share = " + std::string{share}));
    ASSERT_EQ(frames.size(), 6U);
    EXPECT_EQ(frames[0].integrity, FrameIntegrity::wrong_size);
    EXPECT_EQ(frames[0].bytes.size(), size);
    EXPECT_EQ(frames[1].bytes.size(), right);
  }
}

TEST_F(SimLineCameraTest, late_frames_hold_up_the_rest_and_keep_their_times) {
  const auto frames = sweep(on_camera("kind = \"late_frames\"\ncount = 2\nlate_ms = 5"));
  ASSERT_EQ(frames.size(), 6U);
  for (int f = 0; f < b_scans; ++f) {
    const auto i = static_cast<std::size_t>(f);
    EXPECT_EQ(frames[i].first_line, triggered_ + f * frame_period);
    // Frame 2 is complete after 6 ms, but waits behind frame 1, which comes 5 ms late, at 9 ms.
    const std::array<hal::Duration, 6> expected{7ms, 9ms, 9ms, 9ms, 10ms, 12ms};
    EXPECT_EQ(handed_out_[i] - triggered_, expected[i]) << f;
  }
}

TEST_F(SimLineCameraTest, a_stuck_sequence_repeats_and_then_jumps) {
  const auto frames = sweep(on_camera("kind = \"stuck_sequence\"\nduration_s = 10\nevery = 2") +
                            on_camera("kind = \"stuck_sequence\"\nduration_s = 10\nevery = 3"));
  std::vector<std::uint64_t> sequence;
  for (const hal::LineFrame& frame : frames)
    sequence.push_back(frame.sequence);
  EXPECT_EQ(sequence, (std::vector<std::uint64_t>{0, 0, 0, 0, 4, 4}));
}

TEST_F(SimLineCameraTest, saturation_drives_whole_lines_to_full_scale) {
  const auto frames = sweep(on_camera("kind = \"saturation\"\ncount = 6\nline_share = 0.5"));
  int saturated = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_EQ(frames[f].integrity, FrameIntegrity::good) << "the driver knows nothing of it";
    for (int line = 0; line < lines; ++line) {
      const bool full = sample(frames[f], line, 0) == 4095;
      saturated += full;
      for (int n = 0; n < samples; ++n)
        ASSERT_EQ(sample(frames[f], line, n),
                  full ? 4095 : static_cast<int>(f) * 512 + line * 16 + n % 16);
    }
  }
  EXPECT_GT(saturated, 12);
  EXPECT_LT(saturated, 36);
}

TEST_F(SimLineCameraTest, a_short_unplugging_while_nobody_looked_is_told) {
  sweep("[[fault]]\ndevice = \"line_camera\"\nkind = \"unplug\"\nat_s = 1\nduration_s = 0.001\n");
  clock_.advance(2s);
  EXPECT_THAT(camera_->wait_frame(10ms), FailsWith(hal::ErrorCode::disconnected));
  camera_->close();
  EXPECT_TRUE(camera_->open({.format = source_->format(), .line_rate_hz = 4e3, .buffers = 4}));
}

TEST_F(SimLineCameraTest, breathing_moves_the_b_scans_and_stays_within_the_source) {
  // A quarter of the period is one sweep: the second begins at the height of the breath.
  const ScanMotion motion{.breathing_b_scans = 2, .breathing_period = 4 * b_scans * frame_period};
  sweep("", motion);
  link_.pulse(clock_.now());
  const auto frames = fetch_all();
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_EQ(frames[0].bytes.data(), source_->frame(0, 2).data());
  EXPECT_EQ(frames[5].bytes.data(), source_->frame(0, 5).data());
  EXPECT_EQ(motion.met_sweep(0, b_scans, 1, 1, 3 * b_scans * frame_period), 0);
}

TEST(SimGalvoTrigger, missed_pulses_are_made_and_not_seen) {
  VirtualClock clock;
  GalvoLink link{1ms};
  FaultSchedule schedule{script_of("[[fault]]\ndevice = \"galvo_trigger\"\n"
                                   "kind = \"missed_pulses\"\nat_s = 0\nduration_s = 10\n"
                                   "every = 4\n")};
  schedule.start(clock.now());
  SimGalvoTrigger trigger{link, clock, &schedule};
  ASSERT_TRUE(trigger.open({}));
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(trigger.pulse());
    clock.advance(2ms);
  }
  EXPECT_EQ(link.sweeps(), 75U);
}

// At the rate of the default plan. Processor time, not wall time: a busy machine does not count.
TEST(SimLineCameraCost, streaming_takes_far_less_than_15_percent_of_a_core) {
  const auto processor_seconds = [] {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
  };
  VirtualClock clock;
  const auto source = numbered_spectra(80, 379, 16);
  GalvoLink link{hal::from_seconds(80 * 379 / 215e3)};
  SimLineCamera camera{*source, link, clock};
  ASSERT_TRUE(camera.open({.format = source->format(), .line_rate_hz = 215e3, .buffers = 96}));
  ASSERT_TRUE(camera.start());
  const TimePoint begin = clock.now();
  const double busy_before_s = processor_seconds();
  for (int volume = 0; volume < 50; ++volume) {
    link.pulse(clock.now());
    for (int b = 0; b < 80; ++b) {
      const auto frame = camera.wait_frame(1s);
      ASSERT_TRUE(frame && *frame);
      camera.release((*frame)->buffer);
    }
  }
  const double share = (processor_seconds() - busy_before_s) / hal::to_seconds(clock.now() - begin);
  EXPECT_EQ(camera.tally().dropped_without_buffer, 0U);
  EXPECT_LT(share, 0.15);
  RecordProperty("processor_share", std::to_string(share));
}

} // namespace
} // namespace octascope::sim
