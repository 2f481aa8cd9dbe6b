// The bytes that each listed control sends, through the kernel, are the right events.
#include "tests/virtual_hardware/hid/hid_bench.h"

namespace octascope::tests {
namespace {

class HidReports : public HidTest {
protected:
  // Plugs the device in and opens it.
  void open(const VirtualPedalKind& kind) {
    pedal_ = plug_in(kind);
    ASSERT_TRUE(pedal_);
    await_udev(); // what it does with the device before this one, too
    const auto opened = controls_.open();
    ASSERT_TRUE(opened) << opened.error().message;
  }
  Moves after(std::initializer_list<std::uint8_t> report) {
    EXPECT_TRUE(pedal_->send(report));
    return read_all();
  }
  std::string leading_model() const {
    return controls_.serving().empty() ? "" : controls_.serving().front().control.model.model;
  }

  std::unique_ptr<VirtualPedal> pedal_;
};

TEST_F(HidReports, vec_infinity) {
  open(vec_pedal());
  EXPECT_EQ(leading_model(), "vec_infinity");
  EXPECT_EQ(after({0x04, 0x00}), (Moves{pressed(2)}));
  EXPECT_EQ(after({0x00, 0x00}), (Moves{released(2)}));
  EXPECT_EQ(after({0x01, 0x00}), (Moves{pressed(0)}));
  EXPECT_EQ(after({0x02, 0x00}), (Moves{released(0), pressed(1)}));
  EXPECT_EQ(after({0x07, 0x00}), (Moves{pressed(0), pressed(2)}));
}

TEST_F(HidReports, philips) {
  open(philips_pedal());
  EXPECT_EQ(leading_model(), "philips_pedal");
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(after({static_cast<std::uint8_t>(1 << i), 0, 0, 0, 0, 0, 0, 0}), (Moves{pressed(i)}));
    EXPECT_EQ(after({0, 0, 0, 0, 0, 0, 0, 0}), (Moves{released(i)}));
  }
}

TEST_F(HidReports, shuttle_xpress) {
  open(shuttle_xpress());
  EXPECT_EQ(leading_model(), "shuttle_xpress");
  EXPECT_EQ(after({0, 0xfe, 0, 0, 0}), Moves{}) << "where the jog was, nobody knows";
  EXPECT_EQ(after({0, 0xff, 0, 0, 0}), (Moves{turned(1)}));
  EXPECT_EQ(after({0, 0x01, 0, 0, 0}), (Moves{turned(2)})) << "it wraps";
  EXPECT_EQ(after({0, 0xff, 0, 0, 0}), (Moves{turned(-2)}));
  EXPECT_EQ(after({0x07, 0xff, 0, 0, 0}), (Moves{pushed(5, 1000)}));
  EXPECT_EQ(after({0xf9, 0xff, 0, 0, 0}), (Moves{pushed(5, -1000)}));
  EXPECT_EQ(after({0, 0xff, 0, 0, 0}), (Moves{pushed(5, 0)})) << "the middle is told";
  for (int i = 0; i < 5; ++i) {
    const int bit = 0x10 << i;
    EXPECT_EQ(after({0, 0xff, 0, static_cast<std::uint8_t>(bit & 0xff),
                     static_cast<std::uint8_t>(bit >> 8)}),
              (Moves{pressed(i)}));
    EXPECT_EQ(after({0, 0xff, 0, 0, 0}), (Moves{released(i)}));
  }
}

TEST_F(HidReports, shuttle_pro) {
  open(shuttle_pro());
  EXPECT_EQ(leading_model(), "shuttle_pro");
  EXPECT_EQ(after({0, 7, 0, 0x01, 0x40}), (Moves{pressed(0), pressed(14)}));
  EXPECT_EQ(after({0, 6, 0, 0x00, 0x20}),
            (Moves{turned(-1), released(0), pressed(13), released(14)}));
}

TEST_F(HidReports, space_navigator_and_its_lamp) {
  open(space_navigator());
  EXPECT_EQ(leading_model(), "space_mouse");
  EXPECT_EQ(pedal_->output(), (std::vector<std::uint8_t>{4, 1}));
  EXPECT_EQ(after({1, 0x5e, 0x01, 0xa2, 0xfe, 0xaf, 0x00}),
            (Moves{pushed(0, 1000), pushed(1, -1000), pushed(2, 500)}));
  EXPECT_EQ(after({2, 0, 0, 0x23, 0x00, 0xa2, 0xfe}), (Moves{pushed(4, 100), pushed(5, -1000)}));
  EXPECT_EQ(after({1, 0, 0, 0, 0, 0, 0}), (Moves{pushed(0, 0), pushed(1, 0), pushed(2, 0)}));
  EXPECT_EQ(after({3, 0x01, 0x00}), (Moves{pressed(0)}));
  EXPECT_EQ(after({3, 0x02, 0x00}), (Moves{released(0), pressed(1)}));
  controls_.close();
  EXPECT_EQ(pedal_->output(), (std::vector<std::uint8_t>{4, 0}));
}

TEST_F(HidReports, space_mouse_wireless) {
  open(space_mouse());
  EXPECT_EQ(leading_model(), "space_mouse");
  EXPECT_EQ(after({1, 0x5e, 0x01, 0, 0, 0, 0, 0, 0, 0, 0, 0xa2, 0xfe}),
            (Moves{pushed(0, 1000), pushed(5, -1000)}));
  EXPECT_EQ(after({3, 0x02, 0x00}), (Moves{pressed(1)}));
}

TEST_F(HidReports, surface_dial) {
  open(surface_dial());
  EXPECT_EQ(leading_model(), "surface_dial");
  EXPECT_EQ(after({1, 0x01, 0, 0, 0, 0, 0, 0}), (Moves{pressed(0)}));
  EXPECT_EQ(after({1, 0x03, 25, 0, 0, 0, 0, 0}), (Moves{turned(2)}));
  EXPECT_EQ(after({1, 0x03, 5, 0, 0, 0, 0, 0}), (Moves{turned(1)})) << "what was left is kept";
  EXPECT_EQ(after({1, 0x00, 0xec, 0xff, 0, 0, 0, 0}), (Moves{turned(-2), released(0)}));
}

TEST_F(HidReports, pcsensor_as_it_is_shipped_types_b) {
  open(pcsensor_pedal());
  EXPECT_EQ(leading_model(), "pcsensor_single");
  EXPECT_EQ(after({1, 0, 0, 0x05, 0, 0, 0, 0, 0}), (Moves{pressed(0)}));
  EXPECT_EQ(after({1, 0, 0, 0, 0, 0, 0, 0, 0}), (Moves{released(0)}));
  EXPECT_EQ(after({1, 0x02, 0, 0x1e, 0, 0, 0, 0, 0}), (Moves{pressed(0)}))
      << "or whatever it was programmed to";
}

TEST_F(HidReports, pcsensor_triple) {
  open(pcsensor_pedal("PCsensor FootSwitch3-F1.8"));
  EXPECT_EQ(leading_model(), "pcsensor_triple");
  EXPECT_EQ(after({1, 0, 0, 0x04, 0x06, 0, 0, 0, 0}), (Moves{pressed(0), pressed(2)}));
  EXPECT_EQ(after({1, 0, 0, 0x05, 0, 0, 0, 0, 0}), (Moves{released(0), pressed(1), released(2)}));
}

TEST_F(HidReports, powermate_and_its_lamp) {
  const auto knob = plug_in_knob();
  ASSERT_TRUE(knob);
  ASSERT_TRUE(controls_.open());
  EXPECT_EQ(leading_model(), "powermate");
  EXPECT_EQ(knob->lamp(), 255);
  EXPECT_TRUE(knob->turn(-3));
  EXPECT_EQ(read_all(), (Moves{turned(-3)}));
  EXPECT_TRUE(knob->press(true));
  EXPECT_EQ(read_all(), (Moves{pressed(0)}));
  EXPECT_TRUE(knob->turn(1));
  EXPECT_TRUE(knob->press(false));
  EXPECT_EQ(read_all(), (Moves{turned(1), released(0)}));
  controls_.close();
  EXPECT_EQ(knob->lamp(), 0);
}

} // namespace
} // namespace octascope::tests
