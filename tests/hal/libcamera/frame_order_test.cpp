#include <random>

#include <gtest/gtest.h>

#include "hal/linux/libcamera/frame_order.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::tests {
namespace {

using hal::Duration;
using hal::TimePoint;
using hal::linux_backend::FrameOrder;
using namespace std::chrono_literals;

TimePoint at_ms(std::int64_t ms) {
  return TimePoint{std::chrono::milliseconds{ms}};
}
std::uint64_t ns(TimePoint time) {
  return static_cast<std::uint64_t>(time.time_since_epoch().count());
}

TEST(FrameOrder, counts_from_nought_and_shows_gaps_across_the_wrap) {
  FrameOrder order;
  std::int64_t ms = 10'000;
  const auto sequence = [&](std::uint32_t driver) {
    ms += 33;
    return order.place({driver, {}, ns(at_ms(ms))}, at_ms(ms + 5)).sequence;
  };
  EXPECT_EQ(sequence(0xFFFFFFFE), 0U);
  EXPECT_EQ(sequence(0xFFFFFFFF), 1U);
  EXPECT_EQ(sequence(0), 2U) << "wrapped";
  EXPECT_EQ(sequence(4), 6U) << "three lost";
  EXPECT_EQ(sequence(4), 7U) << "a driver whose counter stands still";
  EXPECT_EQ(sequence(2), 8U) << "a driver that began anew";
  EXPECT_EQ(sequence(3), 9U);
}

TEST(FrameOrder, takes_the_exposure_then_the_buffer_then_the_arrival) {
  EXPECT_EQ(FrameOrder{}.place({0, 4'000'000'000, 4'010'000'000}, at_ms(4020)).time, at_ms(4000));
  EXPECT_EQ(FrameOrder{}.place({0, {}, 4'010'000'000}, at_ms(4020)).time, at_ms(4010));
  EXPECT_EQ(FrameOrder{}.place({0, {}, 0}, at_ms(4020)).time, at_ms(4020));
  EXPECT_EQ(FrameOrder{}.place({0, 99'000'000'000, 4'010'000'000}, at_ms(4020)).time, at_ms(4010))
      << "a clock that ran on while the machine slept";
}

TEST(FrameOrder, rises_and_stays_in_the_past_whatever_a_driver_says) {
  std::mt19937_64 random{fresh_seed()};
  for (int round = 0; round < 300; ++round) {
    FrameOrder order;
    TimePoint arrival = at_ms(100'000);
    std::optional<FrameOrder::Place> last;
    for (int i = 0; i < 50; ++i) {
      arrival += Duration{1 + static_cast<std::int64_t>(random() % 40'000'000)};
      const auto near = ns(arrival) - 30'000'000 + random() % 60'000'000;
      hal::linux_backend::RequestStamp stamp{static_cast<std::uint32_t>(random()), {}, random()};
      if (random() % 2 == 0)
        stamp.exposed_ns = static_cast<std::int64_t>(random() % 2 == 0 ? random() : near);
      if (random() % 2 == 0)
        stamp.filled_ns = near;
      const FrameOrder::Place place = order.place(stamp, arrival);
      EXPECT_LE(place.time, arrival);
      if (last) {
        EXPECT_GT(place.time, last->time);
        EXPECT_GT(place.sequence, last->sequence);
      }
      last = place;
    }
  }
}

} // namespace
} // namespace octascope::tests
