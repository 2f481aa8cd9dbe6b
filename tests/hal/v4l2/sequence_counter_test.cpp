#include <random>

#include <gtest/gtest.h>

#include "hal/linux/v4l2/sequence_counter.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

TEST(SequenceCounter, begins_at_nought_whatever_the_driver_says) {
  for (const std::uint32_t first : {0U, 1U, 4711U, 0x7FFF'FFFFU, 0x8000'0000U, 0xFFFF'FFFFU}) {
    SequenceCounter counter;
    EXPECT_EQ(counter.extend(first), 0U);
    EXPECT_EQ(counter.extend(first + 1), 1U);
    EXPECT_EQ(counter.extend(first + 5), 5U);
  }
}

TEST(SequenceCounter, goes_on_over_many_wraps) {
  std::mt19937_64 random{tests::fresh_seed()};
  SequenceCounter counter;
  std::uint64_t truth = random() % 1'000'000;
  const std::uint64_t first = truth;
  counter.extend(static_cast<std::uint32_t>(truth));
  while (truth < 40ULL << 32) {
    truth += random() % 0x7FFF'FFFF;
    ASSERT_EQ(counter.extend(static_cast<std::uint32_t>(truth)), truth - first);
  }
}

TEST(SequenceCounter, a_hung_counter_hangs_and_catches_up) {
  SequenceCounter counter;
  counter.extend(10);
  EXPECT_EQ(counter.extend(12), 2U);
  EXPECT_EQ(counter.extend(12), 2U);
  EXPECT_EQ(counter.extend(15), 5U);
}

TEST(SequenceCounter, a_counter_that_begins_anew_goes_back_but_not_below_nought) {
  SequenceCounter counter;
  counter.extend(100);
  EXPECT_EQ(counter.extend(110), 10U);
  EXPECT_EQ(counter.extend(107), 7U);
  EXPECT_EQ(counter.extend(0), 0U);
  EXPECT_EQ(counter.extend(1), 1U);
}

} // namespace
} // namespace octascope::hal::linux_backend
