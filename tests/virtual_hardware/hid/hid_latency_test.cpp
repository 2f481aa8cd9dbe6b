// How long a report is under way: from the device to the event that is delivered.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <thread>
#include <vector>

#include "tests/virtual_hardware/hid/hid_bench.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

class HidLatency : public HidTest {};

// The control thread's part, and a hand that turns: the time is only told, as the bench's kernel
// has one processor of a machine that others use, too.
TEST_F(HidLatency, of_each_turn_of_a_knob) {
  const auto dial = plug_in(surface_dial());
  ASSERT_TRUE(dial);
  await_udev();
  ASSERT_TRUE(controls_.open());
  constexpr int turns = 400;
  std::atomic<bool> over{false};
  std::vector<hal::TimePoint> told;
  told.reserve(turns);
  std::thread control{[&] {
    std::array<hal::ControlEvent, 16> events;
    while (!over.load() && told.size() < turns)
      for (std::size_t i = 0, count = controls_.read(events, 50ms).value_or(0); i < count; ++i)
        told.push_back(clock_.now());
  }};
  std::vector<hal::TimePoint> turned;
  for (int i = 0; i < turns; ++i) {
    clock_.sleep_for(2ms);
    turned.push_back(clock_.now());
    EXPECT_TRUE(dial->send({1, 0, 10, 0, 0, 0, 0, 0})); // one detent
  }
  clock_.sleep_for(1s);
  over = true;
  control.join();
  ASSERT_EQ(told.size(), turned.size()) << "each turn is one event";
  std::vector<double> us;
  for (std::size_t i = 0; i < told.size(); ++i)
    us.push_back(hal::to_ms(told[i] - turned[i]) * 1000);
  std::ranges::sort(us);
  std::printf("  report to event: median %.0f us, 90 %% within %.0f us, longest %.0f us\n",
              us[us.size() / 2], us[us.size() * 9 / 10], us.back());
}

} // namespace
} // namespace octascope::tests
