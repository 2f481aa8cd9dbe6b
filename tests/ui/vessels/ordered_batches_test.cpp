// Batches reach GL once each and in order, whoever expands them.
#include <array>
#include <atomic>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "ui/vessels/scene/ordered_batches.h"

namespace octascope::tests {
namespace {

// Takes a while that depends on what is drawn.
std::uint32_t work(std::uint32_t rounds) {
  std::atomic<std::uint32_t> sum{0};
  for (std::uint32_t i = 0; i < rounds; ++i)
    sum.store(sum.load(std::memory_order_relaxed) + i, std::memory_order_relaxed);
  return sum;
}

TEST(OrderedBatches, come_once_each_and_in_order) {
  constexpr std::uint32_t slots = 3;
  ui::OrderedBatches order{slots, {}};
  std::mt19937 engine{11};
  const auto random = [&](std::uint32_t below) {
    return static_cast<std::uint32_t>(engine() % below);
  };
  for (int turn = 0; turn < 200; ++turn) {
    const std::uint32_t batches = random(200);
    const std::uint32_t slow_caller = random(2000);
    const std::uint32_t slow_helper = random(2000);
    std::array<std::uint32_t, slots> content{};
    std::vector<std::uint32_t> submitted;
    order.run(
        batches,
        [&](std::uint32_t batch) {
          work(slow_caller);
          submitted.push_back(batch);
        },
        [&](std::uint32_t batch, std::uint32_t slot) {
          work(slow_helper);
          content[slot] = batch + 1;
        },
        [&](std::uint32_t batch, std::uint32_t slot) {
          EXPECT_EQ(content[slot], batch + 1) << "the slot still holds what was expanded for it";
          content[slot] = 0;
          submitted.push_back(batch);
        });
    ASSERT_EQ(submitted.size(), batches);
    for (std::uint32_t i = 0; i < batches; ++i)
      ASSERT_EQ(submitted[i], i);
  }
}

// On a busy machine it may come late to every turn: this one waits for it.
TEST(OrderedBatches, are_expanded_ahead_by_the_helper) {
  ui::OrderedBatches order{3, {}};
  std::atomic<bool> helping{false};
  int by_helper = 0;
  order.run(
      50,
      [&](std::uint32_t batch) {
        if (batch == 0)
          helping.wait(false);
      },
      [&](std::uint32_t, std::uint32_t) {
        helping = true;
        helping.notify_one();
      },
      [&](std::uint32_t, std::uint32_t) { ++by_helper; });
  EXPECT_GT(by_helper, 0);
}

} // namespace
} // namespace octascope::tests
