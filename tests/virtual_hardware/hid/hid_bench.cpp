#include "tests/virtual_hardware/hid/hid_bench.h"

#include <array>
#include <filesystem>
#include <span>
#include <thread>

namespace octascope::tests {

std::string virtual_controls_missing() {
  const std::string pedal = virtual_pedal_missing();
  return pedal.empty() ? uinput_missing() : pedal;
}

std::unique_ptr<VirtualPedal> plug_in(const VirtualPedalKind& kind) {
  auto pedal = VirtualPedal::plug_in(kind);
  EXPECT_TRUE(pedal) << pedal.error().message;
  return pedal ? std::move(*pedal) : nullptr;
}

std::unique_ptr<VirtualKnob> plug_in_knob() {
  auto knob = VirtualKnob::plug_in();
  EXPECT_TRUE(knob) << knob.error().message;
  return knob ? std::move(*knob) : nullptr;
}

void await_udev() {
  for (int tries = 0; tries < 10'000 && std::filesystem::exists("/run/udev/queue"); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
}

void HidTest::SetUp() {
  if (const std::string missing = virtual_controls_missing(); !missing.empty())
    GTEST_SKIP() << missing;
}

Moves HidTest::read_all(hal::ControlInput& input) {
  std::array<hal::ControlEvent, 16> events;
  Moves moves;
  while (true) {
    const auto count = input.read(events, std::chrono::milliseconds{100});
    EXPECT_TRUE(count) << count.error().message;
    if (!count || *count == 0)
      return moves;
    for (const hal::ControlEvent& event : std::span{events}.first(*count))
      moves.push_back({event.kind, event.index, event.value});
  }
}

} // namespace octascope::tests
