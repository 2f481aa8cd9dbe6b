#include <atomic>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "sim/devices/galvo_link.h"

namespace octascope::sim {
namespace {

using hal::TimePoint;
using namespace std::chrono_literals;

constexpr TimePoint t0{1s};

// A pulse during a sweep is latched one deep: against a scanner that is stepped through time,
// nanosecond by nanosecond.
TEST(GalvoLink, agrees_with_a_stepped_scanner_on_random_pulses) {
  std::mt19937 random{3};
  GalvoLink link{hal::Duration{20}};
  std::vector<std::int64_t> starts;
  std::uint64_t lost = 0;
  bool latched = false;
  std::int64_t sweep_ends = -1;
  for (std::int64_t ns = 0; ns < 50000; ++ns) {
    if (ns >= sweep_ends && latched) {
      latched = false;
      sweep_ends = ns + 20;
      starts.push_back(ns);
    }
    if (random() % 15 != 0)
      continue;
    PulseFate fate = PulseFate::lost;
    if (ns >= sweep_ends) {
      sweep_ends = ns + 20;
      starts.push_back(ns);
      fate = PulseFate::started;
    } else if (!latched) {
      latched = true;
      fate = PulseFate::latched;
    } else {
      ++lost;
    }
    ASSERT_EQ(link.pulse(TimePoint{hal::Duration{ns}}), fate);
    ASSERT_EQ(link.lost_pulses(), lost);
    ASSERT_EQ(link.sweeps(), starts.size() + (latched ? 1 : 0));
    ASSERT_EQ(link.start_of(starts.size() - 1), TimePoint{hal::Duration{starts.back()}});
    ASSERT_FALSE(link.start_of(link.sweeps()));
  }
  EXPECT_GT(lost, 100U);
}

TEST(GalvoLink, old_sweeps_are_forgotten_and_never_mistaken) {
  GalvoLink link{1ms};
  constexpr std::uint64_t sweeps = 20000;
  std::atomic<int> wrong{0};
  std::thread reader{[&] {
    for (std::uint64_t seen = 0; seen < sweeps; seen = link.sweeps()) {
      const std::uint64_t oldest = seen > GalvoLink::memory + 2 ? seen - GalvoLink::memory - 2 : 0;
      for (std::uint64_t i = oldest; i < seen; ++i) {
        const auto start = link.start_of(i);
        wrong += start && *start != t0 + static_cast<std::int64_t>(i) * 1ms;
      }
    }
  }};
  for (std::uint64_t i = 0; i < sweeps; ++i)
    link.pulse(t0 + static_cast<std::int64_t>(i) * 1ms);
  reader.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_FALSE(link.start_of(sweeps - GalvoLink::memory));
  EXPECT_TRUE(link.start_of(sweeps - GalvoLink::memory + 1));
}

} // namespace
} // namespace octascope::sim
