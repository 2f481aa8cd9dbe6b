// HID controls under their device's contract: a VEC pedal by uhid and hidraw, completed by a
// PowerMate by uinput and evdev.
#include "tests/contract/control_input_contract.h"
#include "tests/virtual_hardware/hid/hid_bench.h"

namespace octascope::tests {
namespace {

class HidControlsBench final : public ControlInputBench {
public:
  HidControlsBench() { replug(); }

  hal::ControlInput& input() override { return controls_; }
  hal::Clock& clock() override { return clock_; }
  int switches() const override { return 4; } // three of the pedal, and the knob's
  void set_switch(int index, bool is_pressed) override {
    if (bouncing_)
      for (const bool level : {is_pressed, !is_pressed, is_pressed, !is_pressed})
        set_contact(index, level);
    set_contact(index, is_pressed);
  }
  bool can_bounce() const override { return true; }
  void make_bouncing() override { bouncing_ = true; }
  void turn_knob(int detents) override { EXPECT_TRUE(knob_->turn(detents)); }
  bool can_unplug() const override { return true; }
  void unplug() override {
    pedal_.reset();
    knob_.reset();
  }
  void replug() override {
    pedal_ = plug_in(vec_pedal());
    knob_ = plug_in_knob();
    await_udev();
    down_ = 0;
  }

private:
  void set_contact(int index, bool is_pressed) {
    if (index == 3) {
      EXPECT_TRUE(knob_->press(is_pressed));
      return;
    }
    const int bit = 1 << index;
    down_ = is_pressed ? down_ | bit : down_ & ~bit;
    EXPECT_TRUE(pedal_->send({static_cast<std::uint8_t>(down_), 0}));
  }

  std::unique_ptr<VirtualPedal> pedal_;
  std::unique_ptr<VirtualKnob> knob_;
  int down_ = 0;
  bool bouncing_ = false;
  hal::linux_backend::MonotonicClock clock_;
  hal::linux_backend::HidControls controls_{clock_};
};

std::vector<ControlInputCase> cases() {
  if (!virtual_controls_missing().empty())
    return {}; // HidTest says so
  return {{"hid", [] { return std::make_unique<HidControlsBench>(); }}};
}

INSTANTIATE_TEST_SUITE_P(bench, ControlInputContract, testing::ValuesIn(cases()), NameOfCase{});
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ControlInputContract);

} // namespace
} // namespace octascope::tests
