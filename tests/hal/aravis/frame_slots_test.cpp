#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "hal/linux/aravis/frame_slots.h"
#include "hal/semaphore.h"

namespace octascope::tests {
namespace {

using hal::linux_backend::FrameSlots;

TEST(FrameSlots, a_slot_goes_round) {
  FrameSlots slots{2, 100};
  EXPECT_EQ(slots.bytes(1).size(), 100U);
  EXPECT_EQ(slots.fetch(), std::nullopt);
  EXPECT_TRUE(slots.queue(1));
  EXPECT_FALSE(slots.queue(1)) << "the stream has it";
  EXPECT_FALSE(slots.give_back(1)) << "nobody has borrowed it";
  slots.serve(1, {.sequence = 7});
  EXPECT_EQ(slots.fetch(), 1);
  EXPECT_EQ(slots.frame(1).sequence, 7U);
  EXPECT_FALSE(slots.queue(1)) << "it is on loan";
  EXPECT_TRUE(slots.give_back(1));
  EXPECT_FALSE(slots.give_back(1));
  EXPECT_TRUE(slots.queue(1));
  slots.drop(1);
  EXPECT_TRUE(slots.queue(1));
}

TEST(FrameSlots, strange_numbers_are_ignored) {
  FrameSlots slots{2, 100};
  for (const int number : {-1, 2, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()})
    EXPECT_FALSE(slots.give_back(number));
}

TEST(FrameSlots, a_reset_takes_back_all_but_the_loans) {
  FrameSlots slots{3, 100};
  for (int i = 0; i < 3; ++i)
    slots.queue(i);
  slots.serve(2, {});
  slots.serve(0, {});
  EXPECT_EQ(slots.fetch(), 2) << "oldest first";
  slots.reset();
  EXPECT_EQ(slots.fetch(), std::nullopt);
  EXPECT_TRUE(slots.queue(0));
  EXPECT_TRUE(slots.queue(1));
  EXPECT_FALSE(slots.queue(2));
}

// A stream, a reader and one that gives back, each on a thread: what the sanitizers watch.
TEST(FrameSlots, three_threads_lose_nothing) {
  constexpr int frames = 20'000;
  FrameSlots slots{4, 64};
  hal::Semaphore served;
  hal::Semaphore idle;
  std::thread stream{[&] {
    for (int next = 0; next < frames;) {
      bool any = false;
      for (int slot = 0; slot < slots.count() && next < frames; ++slot)
        if (slots.queue(slot)) {
          any = true;
          slots.bytes(slot)[0] = static_cast<std::byte>(next);
          slots.serve(slot, {.sequence = static_cast<std::uint64_t>(next++)});
          served.post();
        }
      if (!any)
        idle.wait();
    }
  }};
  for (int next = 0; next < frames; ++next) {
    served.wait();
    const auto slot = slots.fetch();
    ASSERT_TRUE(slot);
    ASSERT_EQ(slots.frame(*slot).sequence, static_cast<std::uint64_t>(next));
    ASSERT_EQ(slots.bytes(*slot)[0], static_cast<std::byte>(next));
    ASSERT_TRUE(slots.give_back(*slot));
    idle.post();
  }
  stream.join();
}

} // namespace
} // namespace octascope::tests
