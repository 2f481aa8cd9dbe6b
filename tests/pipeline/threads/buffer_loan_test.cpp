#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/threads/buffer_loan.h"

namespace octascope::pipeline {
namespace {

TEST(BufferLoan, lends_the_open_buffer_with_the_lowest_number_above) {
  BufferLoan<3> loan;
  EXPECT_FALSE(loan.borrow_after(0));
  EXPECT_FALSE(loan.lent());
  loan.open(2, 10);
  loan.open(0, 11);
  const auto lent = loan.borrow_after(9);
  ASSERT_TRUE(lent);
  EXPECT_EQ(lent->buffer, 2U);
  EXPECT_EQ(lent->number, 10U);
  EXPECT_EQ(loan.lent(), 2U);
  loan.give_back();
  EXPECT_FALSE(loan.lent());
  EXPECT_EQ(loan.borrow_after(10)->buffer, 0U);
  loan.close(0);
  EXPECT_EQ(loan.lent(), 0U) << "what is on loan remains so";
  loan.give_back();
  EXPECT_FALSE(loan.borrow_after(10));
}

// An owner that fills one buffer after the other, all the time, and a reader that looks into what is
// being filled: what it has borrowed is of one number, whatever the owner does meanwhile.
TEST(BufferLoan, what_is_lent_is_not_used_anew) {
  constexpr int loans = 5000; // at least
  constexpr std::size_t buffers = 3;
  constexpr std::size_t parts = 4;
  struct Contents {
    std::array<std::uint64_t, parts> part{}; // not atomic: a race would be seen
    std::atomic<std::size_t> filled{0};
  };
  BufferLoan<buffers> loan;
  std::array<Contents, buffers> pool;
  std::atomic<bool> over{false};
  std::jthread owner{[&] {
    std::deque<std::uint32_t> free{0, 1, 2};
    for (std::uint64_t number = 1; !over.load(); ++number) {
      const auto found = std::ranges::find_if(
          free, [lent = loan.lent()](std::uint32_t buffer) { return buffer != lent; });
      if (found == free.end())
        continue;
      const std::uint32_t buffer = *found;
      free.erase(found);
      Contents& contents = pool[buffer];
      contents.filled.store(0, std::memory_order_relaxed);
      loan.open(buffer, number);
      for (std::size_t i = 0; i < parts; ++i) {
        contents.part[i] = number;
        contents.filled.store(i + 1, std::memory_order_release);
      }
      loan.close(buffer);
      free.push_back(buffer);
    }
  }};
  for (int borrowed = 0; borrowed < loans;) {
    const auto lent = loan.borrow_after(0);
    if (!lent)
      continue;
    ++borrowed;
    const Contents& contents = pool[lent->buffer];
    const std::size_t filled = contents.filled.load(std::memory_order_acquire);
    for (std::size_t i = 0; i < filled; ++i)
      EXPECT_EQ(contents.part[i], lent->number);
    loan.give_back();
  }
  over.store(true);
}

} // namespace
} // namespace octascope::pipeline
