#include <deque>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/threads/index_ring.h"

namespace octascope::pipeline {
namespace {

// Model test: any sequence of operations behaves as a plain deque that drops its oldest.
TEST(IndexRing, behaves_as_a_bounded_deque) {
  IndexRing ring{8};
  std::deque<std::uint32_t> model;
  std::mt19937 random{1};
  for (std::uint32_t step = 0; step < 20000; ++step) {
    if (random() % 2 == 0) {
      const auto dropped = ring.push_dropping_oldest(step);
      model.push_back(step);
      if (model.size() > ring.capacity()) {
        ASSERT_EQ(dropped, model.front());
        model.pop_front();
      } else {
        ASSERT_FALSE(dropped);
      }
    } else {
      const auto popped = ring.pop();
      if (model.empty()) {
        ASSERT_FALSE(popped);
      } else {
        ASSERT_EQ(popped, model.front());
        model.pop_front();
      }
    }
  }
}

// Whatever the interleaving, each number comes out exactly once: by a consumer or as dropped.
TEST(IndexRing, loses_and_doubles_nothing_between_threads) {
  constexpr std::uint32_t numbers = 200000;
  IndexRing ring{16};
  std::vector<std::atomic<int>> seen(numbers);
  std::atomic<bool> done{false};
  const auto consume = [&] {
    while (true) {
      const bool last_round = done.load();
      while (const auto number = ring.pop())
        seen[*number].fetch_add(1);
      if (last_round)
        return;
    }
  };
  std::thread first{consume};
  std::thread second{consume};
  for (std::uint32_t number = 0; number < numbers; ++number) {
    if (const auto dropped = ring.push_dropping_oldest(number))
      seen[*dropped].fetch_add(1);
  }
  done.store(true);
  first.join();
  second.join();
  for (std::uint32_t number = 0; number < numbers; ++number)
    ASSERT_EQ(seen[number].load(), 1) << number;
}

} // namespace
} // namespace octascope::pipeline
