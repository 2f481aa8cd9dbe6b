#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "hal/linux/system/flip_pacing.h"

namespace octascope::tests {
namespace {

using hal::Duration;
using hal::TimePoint;
using hal::linux_backend::FlipPacer;
using hal::linux_backend::FlipTimes;
using namespace std::chrono_literals;

constexpr Duration period = 16666667ns;
constexpr TimePoint start{1000s};

// Times of a loop that draws for `drawing`, hands the picture over, and waits for the pacer.
// `output` says what comes of a picture that is handed over at a time.
struct Loop {
  std::vector<TimePoint> completed;
  std::vector<Duration> waited; // for the pacer, beyond the flip itself

  Loop(int frames, const std::function<Duration()>& drawing,
       const std::function<FlipTimes(TimePoint)>& output) {
    FlipPacer pacer{period, start};
    TimePoint now = start;
    for (int i = 0; i < frames; ++i) {
      const FlipTimes flip = output(now + drawing());
      completed.push_back(pacer.completed(flip));
      now = std::max(flip.received, pacer.next_allowed());
      waited.push_back(now - flip.received);
    }
  }

  Duration mean() const {
    return (completed.back() - completed.front()) / static_cast<int>(completed.size() - 1);
  }
  Duration longest_wait() const { return *std::max_element(waited.begin(), waited.end()); }
};

// A monitor: the next of its refreshes, which are as long as `real` says, with a stamp of the start
// of scan-out, which lies a little after the event.
std::function<FlipTimes(TimePoint)> monitor(Duration real) {
  return [real](TimePoint submitted) {
    const auto refreshes = (submitted - start) / real + 1;
    const TimePoint refresh = start + refreshes * real;
    return FlipTimes{submitted, refresh + 500us, refresh + 60us};
  };
}

TEST(FlipPacer, leaves_a_monitor_its_own_pace) {
  for (const Duration real : {period, period * 10005 / 10000, period * 9995 / 10000}) {
    const Loop loop{5000, [] { return 3ms; }, monitor(real)};
    EXPECT_EQ(loop.mean(), real);
    // Beyond the stamp nothing is waited for: else drawing would lose that time of every frame.
    EXPECT_LE(loop.longest_wait(), 440us);
  }
}

TEST(FlipPacer, lets_slow_drawing_miss_refreshes_without_waiting_more) {
  const Loop loop{500, [] { return 20ms; }, monitor(period)};
  EXPECT_EQ(loop.mean(), 2 * period);
  EXPECT_LE(loop.longest_wait(), 440us);
}

TEST(FlipPacer, slows_an_output_that_flips_at_once) {
  std::mt19937_64 random{5};
  for (const bool stamped : {false, true}) {
    const auto at_once = [&](TimePoint submitted) {
      const TimePoint done = submitted + 100us;
      return FlipTimes{submitted, stamped ? std::optional{done} : std::nullopt, done};
    };
    const Loop quick{1000, [] { return 1ms; }, at_once};
    EXPECT_EQ(quick.mean(), period);
    std::uniform_int_distribution drawing{0, 16000};
    const Loop uneven{1000, [&] { return std::chrono::microseconds{drawing(random)}; }, at_once};
    EXPECT_GE(uneven.mean(), period * 9 / 10);
    EXPECT_LE(uneven.mean(), period * 11 / 10);
  }
}

TEST(FlipPacer, tells_the_next_refresh_of_an_output_that_paces_itself) {
  FlipPacer pacer{period, start};
  EXPECT_EQ(pacer.next_refresh(), std::nullopt) << "nothing was shown yet";
  const auto output = monitor(period);
  TimePoint now = start;
  for (int i = 0; i < 10; ++i) {
    const FlipTimes flip = output(now + 3ms);
    const TimePoint completed = pacer.completed(flip);
    if (i > 0) {
      EXPECT_EQ(pacer.next_refresh(), completed + period);
    }
    now = flip.received;
  }
  EXPECT_NE(pacer.next_refresh(), std::nullopt);
}

TEST(FlipPacer, tells_no_refresh_of_an_output_that_flips_at_once) {
  FlipPacer pacer{period, start};
  TimePoint now = start;
  for (int i = 0; i < 100; ++i) {
    now = std::max(now, pacer.next_allowed()) + (i % 10 == 9 ? 300ms : i % 7 == 6 ? 16ms : 3ms);
    pacer.completed({now, std::nullopt, now + 100us});
    EXPECT_EQ(pacer.next_refresh(), std::nullopt) << i << ", after a rest or slow drawing, too";
  }
}

TEST(FlipPacer, leaves_a_slow_output_alone) {
  const Loop loop{50, [] { return 1ms; },
                  [](TimePoint submitted) {
                    return FlipTimes{submitted, {}, submitted + 200ms};
                  }};
  EXPECT_EQ(loop.mean(), 201ms);
  EXPECT_EQ(loop.longest_wait(), 0ns);
}

TEST(FlipPacer, believes_no_stamp_that_cannot_be_true) {
  FlipPacer pacer{period, start};
  const TimePoint submitted = start + 20ms;
  const TimePoint received = submitted + 5ms;
  EXPECT_EQ(pacer.completed({submitted, TimePoint{}, received}), received);
  EXPECT_EQ(pacer.completed({submitted + 1s, start + 3600s, received + 1s}), received + 1s);
  EXPECT_EQ(pacer.completed({submitted + 2s, submitted + 2s + 1ms, received + 2s}),
            submitted + 2s + 1ms);
}

TEST(FlipPacer, never_goes_back_whatever_it_is_told) {
  std::mt19937_64 random{9};
  FlipPacer pacer{period, start};
  TimePoint last = start;
  const auto some = [&] {
    return std::chrono::nanoseconds{static_cast<std::int64_t>(random() % 100'000'000) - 20'000'000};
  };
  TimePoint now = start;
  for (int i = 0; i < 20000; ++i) {
    now += some();
    const TimePoint completed = pacer.completed({now, now + some(), now + some()});
    ASSERT_GE(completed, last);
    ASSERT_LE(pacer.next_allowed() - completed, period) << "never more than one refresh";
    last = completed;
  }
}

} // namespace
} // namespace octascope::tests
