#include <random>

#include <gtest/gtest.h>

#include "hal/linux/gpio/sync_ledger.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

TimePoint at_us(std::int64_t us) {
  return TimePoint{std::chrono::microseconds{us}};
}

TEST(SyncMonitor, tells_answered_missed_and_unexpected) {
  SyncMonitor metadata;
  metadata.edge(at_us(1)); // nobody asked
  metadata.pulse(at_us(10));
  EXPECT_FALSE(metadata.delay());
  metadata.edge(at_us(13));
  EXPECT_EQ(metadata.delay(), std::chrono::microseconds{3});
  metadata.edge(at_us(14));
  EXPECT_EQ(metadata.delay(), std::chrono::microseconds{3}) << "the first one counts";
  metadata.pulse(at_us(20));
  metadata.pulse(at_us(30));
  EXPECT_EQ(metadata.edges(), 3U);
  EXPECT_EQ(metadata.missed(), 1U);
  EXPECT_EQ(metadata.unexpected(), 2U);
}

TEST(SyncMonitor, the_pulse_before_a_pause_is_not_asked_about) {
  SyncMonitor metadata;
  metadata.pulse(at_us(10));
  metadata.forget_pulse();
  metadata.edge(at_us(500));
  metadata.pulse(at_us(1000));
  EXPECT_EQ(metadata.missed(), 0U);
  EXPECT_EQ(metadata.unexpected(), 1U);
}

// What is expected and not missed, and what was not expected, are all the edges there were.
TEST(SyncMonitor, keeps_its_books_balanced) {
  std::mt19937 random{tests::fresh_seed()};
  for (int round = 0; round < 1000; ++round) {
    const std::uint64_t expected = 1 + random() % 16;
    SyncMonitor metadata{expected};
    const std::uint64_t pulses = random() % 20;
    std::uint64_t edges = 0;
    std::int64_t us = 0;
    for (std::uint64_t pulse = 0; pulse < pulses; ++pulse) {
      metadata.pulse(at_us(++us));
      for (auto answers = random() % 20; answers > 0; --answers, ++edges)
        metadata.edge(at_us(++us));
    }
    metadata.pulse(at_us(++us)); // closes the last one
    EXPECT_EQ(metadata.edges(), edges);
    EXPECT_EQ(pulses * expected + metadata.unexpected(), edges + metadata.missed());
  }
}

} // namespace
} // namespace octascope::hal::linux_backend
