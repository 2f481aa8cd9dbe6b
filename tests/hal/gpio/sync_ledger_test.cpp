#include <random>

#include <gtest/gtest.h>

#include "hal/linux/gpio/sync_ledger.h"
#include "tests/support/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

TimePoint at_us(std::int64_t us) {
  return TimePoint{std::chrono::microseconds{us}};
}

TEST(SyncLedger, tells_answered_missed_and_unexpected) {
  SyncLedger ledger;
  ledger.edge(at_us(1)); // nobody asked
  ledger.pulse(at_us(10));
  EXPECT_FALSE(ledger.delay());
  ledger.edge(at_us(13));
  EXPECT_EQ(ledger.delay(), std::chrono::microseconds{3});
  ledger.edge(at_us(14));
  EXPECT_EQ(ledger.delay(), std::chrono::microseconds{3}) << "the first one counts";
  ledger.pulse(at_us(20));
  ledger.pulse(at_us(30));
  EXPECT_EQ(ledger.edges(), 3U);
  EXPECT_EQ(ledger.missed(), 1U);
  EXPECT_EQ(ledger.unexpected(), 2U);
}

TEST(SyncLedger, the_pulse_before_a_pause_is_not_asked_about) {
  SyncLedger ledger;
  ledger.pulse(at_us(10));
  ledger.forget_pulse();
  ledger.edge(at_us(500));
  ledger.pulse(at_us(1000));
  EXPECT_EQ(ledger.missed(), 0U);
  EXPECT_EQ(ledger.unexpected(), 1U);
}

// What is expected and not missed, and what was not expected, are all the edges there were.
TEST(SyncLedger, keeps_its_books_balanced) {
  std::mt19937 random{tests::fresh_seed()};
  for (int round = 0; round < 1000; ++round) {
    const std::uint64_t expected = 1 + random() % 16;
    SyncLedger ledger{expected};
    const std::uint64_t pulses = random() % 20;
    std::uint64_t edges = 0;
    std::int64_t us = 0;
    for (std::uint64_t pulse = 0; pulse < pulses; ++pulse) {
      ledger.pulse(at_us(++us));
      for (auto answers = random() % 20; answers > 0; --answers, ++edges)
        ledger.edge(at_us(++us));
    }
    ledger.pulse(at_us(++us)); // closes the last one
    EXPECT_EQ(ledger.edges(), edges);
    EXPECT_EQ(pulses * expected + ledger.unexpected(), edges + ledger.missed());
  }
}

} // namespace
} // namespace octascope::hal::linux_backend
