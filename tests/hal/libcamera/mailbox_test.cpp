#include <thread>

#include <gtest/gtest.h>

#include "hal/linux/libcamera/mailbox.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/support/allocation_counter.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::Mailbox;
using hal::linux_backend::most_buffers;
using namespace std::chrono_literals;

TEST(Mailbox, keeps_the_order_and_hears_only_the_current_camera) {
  Mailbox box;
  const int camera = 0;
  const int other = 0;
  box.post(&camera, 1);
  EXPECT_FALSE(box.next()) << "nobody listens";
  box.listen_to(&camera);
  box.post(&other, 9);
  box.leave(&other);
  for (const std::uint64_t request : {3U, 0U, 5U})
    box.post(&camera, request);
  box.post(&camera, most_buffers);
  EXPECT_FALSE(box.gone());
  EXPECT_EQ(box.next(), 3U);
  EXPECT_EQ(box.next(), 0U);
  EXPECT_EQ(box.next(), 5U);
  EXPECT_FALSE(box.next());
  box.leave(&camera);
  EXPECT_TRUE(box.gone());
  box.post(&camera, 4);
  box.listen_to(&other);
  EXPECT_FALSE(box.gone());
  EXPECT_FALSE(box.next()) << "news of the camera before";
}

TEST(Mailbox, is_bounded_and_allocates_nothing) {
  Mailbox box;
  const int camera = 0;
  box.listen_to(&camera);
  const auto before = allocations_of_this_thread();
  for (std::size_t i = 0; i < 3 * most_buffers; ++i)
    box.post(&camera, i % most_buffers);
  std::size_t count = 0;
  while (box.next())
    ++count;
  EXPECT_EQ(allocations_of_this_thread(), before);
  EXPECT_EQ(count, most_buffers);
}

TEST(Mailbox, brings_everything_from_another_thread) {
  hal::linux_backend::MonotonicClock clock;
  Mailbox box;
  const int camera = 0;
  box.listen_to(&camera);
  constexpr std::size_t total = 20'000;
  std::atomic<std::size_t> taken{0};
  std::thread poster{[&] {
    for (std::size_t i = 0; i < total; ++i) {
      while (i - taken.load() >= most_buffers)
        std::this_thread::yield();
      box.post(&camera, i % most_buffers);
    }
  }};
  while (taken.load() < total) {
    box.doorbell().silence();
    bool any = false;
    while (const auto request = box.next()) {
      EXPECT_EQ(*request, taken.load() % most_buffers);
      taken.fetch_add(1);
      any = true;
    }
    if (!any && !box.doorbell().wait_until(clock.now() + 10s))
      break;
  }
  poster.join();
  EXPECT_EQ(taken.load(), total);
}

TEST(Doorbell, waits_as_long_as_it_is_told_and_no_longer_than_until_it_rings) {
  hal::linux_backend::MonotonicClock clock;
  hal::linux_backend::Doorbell bell;
  const auto before = clock.now();
  EXPECT_FALSE(bell.wait_until(before + 5ms));
  EXPECT_GE(clock.now() - before, 5ms);
  EXPECT_FALSE(bell.wait_until(before)) << "a time that has passed";
  bell.ring();
  EXPECT_TRUE(bell.wait_until(clock.now() + 10s));
  bell.ring();
  bell.silence();
  EXPECT_FALSE(bell.wait_until(clock.now()));
}

} // namespace
} // namespace octascope::tests
