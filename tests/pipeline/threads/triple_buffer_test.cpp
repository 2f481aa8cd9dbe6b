#include <array>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/threads/triple_buffer.h"

namespace octascope::pipeline {
namespace {

// The obvious implementation: three named slots and a flag.
struct Model {
  std::uint32_t middle = 0;
  std::uint32_t front = 1;
  bool fresh = false;

  TripleBuffer::Published publish(std::uint32_t finished) {
    const TripleBuffer::Published result{middle, fresh};
    middle = finished;
    fresh = true;
    return result;
  }
  std::optional<std::uint32_t> take() {
    if (!fresh)
      return std::nullopt;
    std::swap(middle, front);
    fresh = false;
    return front;
  }
};

// Every sequence of 12 operations agrees with the model, and no index is ever in two places.
TEST(TripleBuffer, agrees_with_the_model_on_every_short_history) {
  constexpr int length = 12;
  for (int history = 0; history < (1 << length); ++history) {
    TripleBuffer buffer{0, 1};
    Model model;
    std::uint32_t back = 2;
    for (int step = 0; step < length; ++step) {
      if ((history >> step) & 1) {
        const auto expected = model.publish(back);
        const auto found = buffer.publish(back);
        ASSERT_EQ(found.recycled, expected.recycled);
        ASSERT_EQ(found.skipped, expected.skipped);
        back = found.recycled;
      } else {
        ASSERT_EQ(buffer.take(), model.take());
      }
      ASSERT_EQ(buffer.front(), model.front);
      ASSERT_EQ((std::set{back, model.middle, buffer.front()}).size(), 3U);
    }
  }
}

// A producer and a consumer at full speed: contents are whole, and never go back in time.
TEST(TripleBuffer, hands_over_whole_contents_in_order) {
  constexpr std::uint64_t rounds = 200000;
  std::array<std::array<std::uint64_t, 16>, 4> pool{}; // two in the producer's hands
  TripleBuffer buffer{0, 1};
  std::thread producer{[&] {
    std::vector<std::uint32_t> free{2, 3};
    for (std::uint64_t round = 1; round <= rounds; ++round) {
      const std::uint32_t index = free.front();
      free.erase(free.begin());
      pool[index].fill(round);
      free.push_back(buffer.publish(index).recycled);
    }
  }};
  std::uint64_t last = 0;
  while (last < rounds) {
    const auto index = buffer.take();
    if (!index)
      continue;
    const auto contents = pool[*index];
    ASSERT_GT(contents[0], last);
    for (const std::uint64_t word : contents)
      ASSERT_EQ(word, contents[0]);
    last = contents[0];
  }
  producer.join();
}

} // namespace
} // namespace octascope::pipeline
