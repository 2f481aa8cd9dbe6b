#include <thread>

#include <gtest/gtest.h>

#include "hal/linux/libcamera/completion_queue.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/support/allocation_counter.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::CompletionQueue;
using hal::linux_backend::most_buffers;
using namespace std::chrono_literals;

TEST(CompletionQueue, keeps_the_order_and_hears_only_the_current_camera) {
  CompletionQueue queue;
  const int camera = 0;
  const int other = 0;
  queue.add(&camera, 1);
  EXPECT_FALSE(queue.next()) << "nobody listens";
  queue.listen_to(&camera);
  queue.add(&other, 9);
  queue.close(&other);
  for (const std::uint64_t request : {3U, 0U, 5U})
    queue.add(&camera, request);
  queue.add(&camera, most_buffers);
  EXPECT_FALSE(queue.gone());
  EXPECT_EQ(queue.next(), 3U);
  EXPECT_EQ(queue.next(), 0U);
  EXPECT_EQ(queue.next(), 5U);
  EXPECT_FALSE(queue.next());
  queue.close(&camera);
  EXPECT_TRUE(queue.gone());
  queue.add(&camera, 4);
  queue.listen_to(&other);
  EXPECT_FALSE(queue.gone());
  EXPECT_FALSE(queue.next()) << "news of the camera before";
}

TEST(CompletionQueue, is_bounded_and_allocates_nothing) {
  CompletionQueue queue;
  const int camera = 0;
  queue.listen_to(&camera);
  const auto before = allocations_of_this_thread();
  for (std::size_t i = 0; i < 3 * most_buffers; ++i)
    queue.add(&camera, i % most_buffers);
  std::size_t count = 0;
  while (queue.next())
    ++count;
  EXPECT_EQ(allocations_of_this_thread(), before);
  EXPECT_EQ(count, most_buffers);
}

TEST(CompletionQueue, brings_everything_from_another_thread) {
  hal::linux_backend::MonotonicClock clock;
  CompletionQueue queue;
  const int camera = 0;
  queue.listen_to(&camera);
  constexpr std::size_t total = 20'000;
  std::atomic<std::size_t> taken{0};
  std::thread poster{[&] {
    for (std::size_t i = 0; i < total; ++i) {
      while (i - taken.load() >= most_buffers)
        std::this_thread::yield();
      queue.add(&camera, i % most_buffers);
    }
  }};
  while (taken.load() < total) {
    queue.semaphore().take_all();
    bool any = false;
    while (const auto request = queue.next()) {
      EXPECT_EQ(*request, taken.load() % most_buffers);
      taken.fetch_add(1);
      any = true;
    }
    if (!any && !clock.wait_until(queue.semaphore(), clock.now() + 10s))
      break;
  }
  poster.join();
  EXPECT_EQ(taken.load(), total);
}

} // namespace
} // namespace octascope::tests
