#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "hal/linux/aravis/camera_clock.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using hal::TimePoint;
using hal::linux_backend::CameraClock;
using hal::linux_backend::FrameCounter;

constexpr TimePoint start{1000s};
constexpr std::uint64_t camera_start_ns = 77'000'000'000;

std::uint64_t stamp(hal::Duration after) {
  return camera_start_ns + static_cast<std::uint64_t>(after.count());
}

// In the first second a clock may be taken as one that drifts by a hundredth.
constexpr auto drift_of_10_ms = 100us;

TEST(CameraClock, a_late_arrival_does_not_make_a_frame_late) {
  CameraClock clock;
  EXPECT_EQ(clock.end_of_frame(stamp(0ms), start + 1ms), start + 1ms);
  const TimePoint end = clock.end_of_frame(stamp(10ms), start + 20ms);
  EXPECT_GE(end, start + 11ms);
  EXPECT_LE(end, start + 11ms + drift_of_10_ms);
}

TEST(CameraClock, an_earlier_arrival_corrects_those_after_it) {
  CameraClock clock;
  clock.end_of_frame(stamp(0ms), start + 9ms);
  EXPECT_EQ(clock.end_of_frame(stamp(10ms), start + 11ms), start + 11ms);
  EXPECT_LE(clock.end_of_frame(stamp(20ms), start + 29ms), start + 21ms + drift_of_10_ms);
}

// A camera on a host that is never quicker than a millisecond.
class DriftingCamera {
public:
  static constexpr hal::Duration least_delay = 1ms;

  // `drift`: of the camera's clock, fast is positive.
  DriftingCamera(double drift, hal::Duration period) : drift_{drift}, period_{period} {}

  // How much later than in truth the next frame is said to have been.
  hal::Duration next_error(hal::Duration more_delay) {
    const hal::Duration host = period_ * frame_++;
    const auto camera =
        hal::Duration{static_cast<std::int64_t>(static_cast<double>(host.count()) * (1 + drift_))};
    const TimePoint arrival = start + host + least_delay + more_delay;
    const TimePoint end = clock.end_of_frame(stamp(camera + leapt), arrival);
    EXPECT_LE(end, arrival);
    was_arrival = end == arrival;
    return end - (start + host + least_delay);
  }
  hal::Duration passed() const { return period_ * frame_; }

  CameraClock clock;
  hal::Duration leapt{};
  bool was_arrival = false;

private:
  double drift_;
  hal::Duration period_;
  int frame_ = 0;
};

// As a busy machine has them: mostly short, sometimes long.
class Delays {
public:
  hal::Duration next() {
    const double even = std::uniform_real_distribution{}(random_);
    return even < 0.02 ? std::chrono::duration_cast<hal::Duration>(40ms * even / 0.02)
                       : std::chrono::duration_cast<hal::Duration>(3ms * even * even);
  }

private:
  std::mt19937_64 random_{fresh_seed()};
};

TEST(CameraClock, a_clock_that_runs_otherwise_is_followed) {
  for (const double drift : {-0.0095, -0.003, -100e-6, 0.0, 100e-6, 0.003, 0.0095}) {
    for (const hal::Duration period : {hal::Duration{1760us}, hal::Duration{40ms}}) {
      DriftingCamera camera{drift, period};
      Delays delays;
      while (camera.passed() < 200s) {
        const hal::Duration error = camera.next_error(delays.next());
        const bool learnt = camera.passed() > 10s;
        ASSERT_GE(error, learnt ? -1ms : -10ms) << drift << " after " << camera.passed().count();
        ASSERT_LE(error, learnt ? 1ms : 40ms) << drift << " after " << camera.passed().count();
        ASSERT_TRUE(camera.clock.fits());
      }
    }
  }
}

TEST(CameraClock, one_that_is_known_is_exact_to_microseconds) {
  DriftingCamera camera{150e-6, 2ms};
  for (int frame = 0; frame < 30'000; ++frame) {
    const hal::Duration error = camera.next_error((frame % 7) * 1ms);
    if (camera.passed() > 1s) {
      ASSERT_GE(error, -10us) << frame;
      ASSERT_LE(error, 10us) << frame;
    }
  }
}

TEST(CameraClock, one_that_is_too_fast_or_too_slow_is_told_and_not_used) {
  for (const double drift : {-0.999, -0.5, -0.02, 0.02, 0.5, 7.0}) {
    DriftingCamera camera{drift, 5ms};
    Delays delays;
    int told = 0;
    while (camera.passed() < 60s) {
      const hal::Duration error = camera.next_error(delays.next());
      ASSERT_GE(error, -40ms) << drift << " after " << camera.passed().count()
                              << ": wrong, and not told";
      if (camera.clock.fits())
        continue;
      ++told;
      ASSERT_TRUE(camera.was_arrival);
    }
    EXPECT_GT(told, 60s / 5ms / 2) << drift;
  }
}

TEST(CameraClock, one_that_sends_no_stamps_is_told) {
  CameraClock clock;
  for (int frame = 0; frame < 100; ++frame) {
    EXPECT_EQ(clock.end_of_frame(0, start + frame * 100ms), start + frame * 100ms);
    EXPECT_EQ(clock.fits(), frame < 50);
  }
}

TEST(CameraClock, pauses_between_volumes_leave_it_as_it_is) {
  constexpr int volumes = 60;
  constexpr int frames = 71;
  for (const double drift : {-0.005, 0.0, 0.005})
    for (const hal::Duration pause : {hal::Duration{2s}, hal::Duration{1h}}) {
      CameraClock clock;
      for (int frame = 0; frame < volumes * frames; ++frame) {
        const hal::Duration host = frame * 2ms + frame / frames * pause;
        const auto drifted = static_cast<std::int64_t>(static_cast<double>(host.count()) * drift);
        const TimePoint end =
            clock.end_of_frame(stamp(host + hal::Duration{drifted}), start + host);
        ASSERT_GE(end, start + host - 10ms) << drift << ", frame " << frame;
        ASSERT_TRUE(clock.fits()) << drift << ", frame " << frame;
      }
    }
}

TEST(CameraClock, one_that_was_set_is_followed_anew) {
  for (const hal::Duration leap :
       {hal::Duration{300ms}, hal::Duration{20ms}, hal::Duration{-80ms}}) {
    DriftingCamera camera{30e-6, 100ms}; // so that stamps go on after any of these
    Delays delays;
    while (camera.passed() < 40s)
      camera.next_error(delays.next());
    camera.leapt = leap;
    const hal::Duration again = camera.passed() + 4s;
    while (camera.passed() < 100s) {
      const hal::Duration error = camera.next_error(delays.next());
      if (camera.passed() > again) {
        ASSERT_GE(error, camera.passed() < again + 10s ? -10ms : -2ms)
            << leap.count() << " after " << camera.passed().count();
        ASSERT_LE(error, camera.passed() < again + 10s ? 40ms : 2ms) << leap.count();
      }
      ASSERT_TRUE(camera.clock.fits());
    }
  }
}

// The camera's clock runs so much faster than the host's, by time; no frame is delayed where `delays` is
// empty. Returns how late a frame was said to be at least and at most after ten seconds.
struct Errors {
  hal::Duration least = 1h;
  hal::Duration most = -1h;
};
template <class Drift> Errors follow(hal::Duration most, Drift drift, Delays* delays) {
  CameraClock clock;
  Errors errors;
  double distance_ns = 0;
  for (hal::Duration camera{}; camera < most; camera += 5ms) {
    distance_ns -= drift(camera) * 5e6;
    const TimePoint end = start + camera + std::chrono::nanoseconds{std::llround(distance_ns)};
    const hal::Duration delay = delays != nullptr ? delays->next() : hal::Duration{};
    const hal::Duration error = clock.end_of_frame(stamp(camera), end + delay) - end;
    EXPECT_TRUE(clock.fits());
    if (camera > 10s) {
      errors.least = std::min(errors.least, error);
      errors.most = std::max(errors.most, error);
    }
  }
  return errors;
}

TEST(CameraClock, a_rate_that_changes_is_followed) {
  for (const double drift : {-20e-6, 20e-6}) {
    Delays delays;
    const Errors errors = follow(
        10min, [&](hal::Duration now) { return now < 5min ? drift : -drift; }, &delays);
    EXPECT_GE(errors.least, -1500us) << drift;
    EXPECT_LE(errors.most, 1ms) << drift;
  }
}

// Each frame is on the hull: more than there is room for.
TEST(CameraClock, a_rate_that_changes_with_each_frame_is_followed) {
  const Errors errors = follow(
      1min, [](hal::Duration now) { return -50e-6 * hal::to_seconds(now); }, nullptr);
  EXPECT_GE(errors.least, -6ms);
  EXPECT_LE(errors.most, 100us);
}

TEST(CameraClock, is_never_later_than_the_arrival) {
  CameraClock clock;
  clock.end_of_frame(stamp(0ms), start + 5ms);
  EXPECT_LE(clock.end_of_frame(stamp(10ms), start + 6ms), start + 6ms);
}

TEST(CameraClock, what_is_no_stamp_gives_the_arrival_and_a_new_beginning) {
  CameraClock clock;
  clock.end_of_frame(stamp(1s), start);
  EXPECT_EQ(clock.end_of_frame(0, start + 10ms), start + 10ms);
  EXPECT_EQ(clock.end_of_frame(stamp(0s), start + 20ms), start + 20ms) << "reset";
  EXPECT_EQ(clock.end_of_frame(stamp(3600s), start + 30ms), start + 30ms) << "a leap";
  EXPECT_EQ(clock.end_of_frame(~0ULL, start + 40ms), start + 40ms);
  EXPECT_EQ(clock.end_of_frame(stamp(5ms), start + 50ms), start + 50ms);
  EXPECT_LE(clock.end_of_frame(stamp(15ms), start + 69ms), start + 60ms + drift_of_10_ms)
      << "exact again";
}

TEST(FrameCounter, begins_at_0_and_shows_gaps) {
  FrameCounter counter;
  EXPECT_EQ(counter.extend(65'000), 0U);
  EXPECT_EQ(counter.extend(65'001), 1U);
  EXPECT_EQ(counter.extend(65'005), 5U);
}

TEST(FrameCounter, short_numbers_go_on_at_1_without_a_gap) {
  FrameCounter counter;
  counter.extend(65'534);
  EXPECT_EQ(counter.extend(65'535), 1U);
  EXPECT_EQ(counter.extend(1), 2U);
  EXPECT_EQ(counter.extend(3), 4U);
}

TEST(FrameCounter, long_numbers_have_no_end) {
  FrameCounter counter;
  counter.extend(65'535);
  EXPECT_EQ(counter.extend(65'536), 1U);
  EXPECT_EQ(counter.extend(5'000'000'000), 4'999'934'465U);
}

TEST(FrameCounter, a_lost_number_is_taken_as_the_next) {
  FrameCounter counter;
  EXPECT_EQ(counter.guess(), 0U);
  EXPECT_EQ(counter.extend(8), 1U);
  EXPECT_EQ(counter.guess(), 2U);
  EXPECT_EQ(counter.guess(), 3U);
  EXPECT_EQ(counter.extend(11), 4U);
  EXPECT_EQ(counter.extend(12), 5U);
}

TEST(FrameCounter, an_old_number_follows_nothing) {
  FrameCounter counter;
  EXPECT_FALSE(counter.follows(0));
  EXPECT_FALSE(counter.follows(65'500)) << "it may be of before the first";
  counter.extend(65'500);
  EXPECT_TRUE(counter.follows(65'501));
  EXPECT_FALSE(counter.follows(65'500));
  EXPECT_FALSE(counter.follows(65'490));
  EXPECT_TRUE(counter.follows(1)) << "after 65535";
  counter.extend(3);
  EXPECT_FALSE(counter.follows(65'530)) << "of before the new beginning";
}

TEST(FrameCounter, a_number_that_hangs_or_goes_back_does_not_advance_it) {
  FrameCounter counter;
  counter.extend(10);
  EXPECT_EQ(counter.extend(12), 2U);
  EXPECT_EQ(counter.extend(12), 2U);
  EXPECT_EQ(counter.extend(11), 2U);
  EXPECT_EQ(counter.extend(13), 4U);
}

} // namespace
} // namespace octascope::tests
