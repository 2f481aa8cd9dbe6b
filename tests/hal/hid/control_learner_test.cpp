#include <random>

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "hal/linux/hid/decoders/hid_decoder.h"
#include "hal/linux/hid/learning/control_learner.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(ControlLearner, finds_the_bits_in_the_order_of_their_presses) {
  ControlLearner learner{false};
  EXPECT_NE(learner.note(Bytes{0, 0x04, 0}).find("bit 0x04: switch 1 down"), std::string::npos);
  EXPECT_FALSE(learner.model(1, 2, "pedal")) << "not let go yet";
  for (const Bytes& report : {Bytes{0, 0, 0}, Bytes{0x80, 0, 0}, Bytes{0, 0, 0}, Bytes{0, 0x01, 0},
                              Bytes{0, 0, 0}, Bytes{0, 0x04, 0}, Bytes{0, 0, 0}})
    learner.note(report);
  EXPECT_EQ(learner.note(Bytes{0, 0, 0}), "") << "nothing has changed";
  const auto model = learner.model(0x1234, 0x5678, "pedal");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->family, HidFamily::mapped);
  EXPECT_EQ(model->switches, 3);
  EXPECT_EQ(model->bits, (std::vector<SwitchBit>{{1, 0x04}, {0, 0x80}, {1, 0x01}}));
  EXPECT_FALSE(model->report_id);
}

TEST(ControlLearner, a_wheel_is_no_switch) {
  ControlLearner learner{false};
  for (std::uint8_t wheel = 0; wheel < 20; ++wheel)
    learner.note(Bytes{wheel, 0});
  learner.note(Bytes{19, 0x02});
  learner.note(Bytes{19, 0});
  EXPECT_EQ(learner.model(1, 2, "")->bits, (std::vector<SwitchBit>{{1, 0x02}}));
}

TEST(ControlLearner, numbered_reports_are_kept_apart) {
  ControlLearner learner{true};
  for (const Bytes& report : {Bytes{1, 0, 0x33}, Bytes{3, 0x01}, Bytes{3, 0}, Bytes{1, 0, 0x44},
                              Bytes{3, 0x02}, Bytes{3, 0}})
    learner.note(report);
  const auto model = learner.model(1, 2, "");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->report_id, 3);
  EXPECT_EQ(model->bits, (std::vector<SwitchBit>{{1, 0x01}, {1, 0x02}}));
}

TEST(ControlLearner, what_types_is_known_by_its_keys) {
  ControlLearner learner{false};
  learner.note(KeyEvent{EV_KEY, KEY_B, 1});
  learner.note(KeyEvent{EV_KEY, KEY_B, 2});
  learner.note(KeyEvent{EV_KEY, KEY_B, 0});
  learner.note(KeyEvent{EV_KEY, KEY_A, 1});
  learner.note(KeyEvent{EV_KEY, BTN_LEFT, 1});
  const auto model = learner.model(1, 2, "");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->family, HidFamily::keyboard);
  EXPECT_EQ(model->keys, (std::vector<std::uint16_t>{KEY_B, KEY_A}));
}

// Whatever is sent, what is learned can be decoded with.
TEST(ControlLearner, what_no_device_sends_harms_nothing) {
  std::mt19937 random{tests::fresh_seed()};
  int learned = 0;
  for (int round = 0; round < 2000; ++round) {
    ControlLearner learner{random() % 2 == 0};
    for (int i = 0; i < 20; ++i) {
      Bytes report(random() % 6);
      for (std::uint8_t& byte : report)
        byte =
            static_cast<std::uint8_t>(random() % 3 == 0 ? random() : 1U << (random() % 9) & 255U);
      learner.note(report);
    }
    if (const auto model = learner.model(1, 2, "")) {
      ++learned;
      ASSERT_LE(model->switches, most_switches);
      const Bytes report(64);
      ASSERT_TRUE(make_hid_decoder(*model));
      make_hid_decoder(*model)->decode(report);
    }
  }
  EXPECT_GT(learned, 20);
}

TEST(ReportIds, are_found_in_descriptors) {
  EXPECT_TRUE(has_report_ids(Bytes{0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0x85, 0x01, 0xc0}));
  EXPECT_FALSE(has_report_ids(Bytes{0x05, 0x85, 0x09, 0x85, 0x26, 0x85, 0x85, 0xc0})) << "values";
  EXPECT_FALSE(has_report_ids(Bytes{0xfe, 0x02, 0x00, 0x85, 0x01, 0xc0})) << "in a long item";
  std::mt19937 random{tests::fresh_seed()};
  for (int round = 0; round < 10'000; ++round) {
    Bytes bytes(random() % 40);
    for (std::uint8_t& byte : bytes)
      byte = static_cast<std::uint8_t>(random());
    has_report_ids(bytes); // and ends
  }
}

} // namespace
} // namespace octascope::hal::linux_backend
