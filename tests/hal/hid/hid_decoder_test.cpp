// Decoders against the bytes that the devices send (the bench sends them through the kernel), and
// against bytes that no device sends.
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "hal/linux/hid/decoders/hid_decoder.h"
#include "hal/linux/hid/decoders/key_decoder.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

using Bytes = std::vector<std::uint8_t>;

ControlModel model_of(std::string_view model) {
  for (const ControlModel& listed : listed_control_models())
    if (listed.model == model)
      return listed;
  ADD_FAILURE() << model;
  return {};
}

// What every reading keeps to, whatever the bytes were.
void expect_sane(const HidReading& reading, const ControlModel& model) {
  if (reading.switches && model.switches < 32) {
    ASSERT_EQ(*reading.switches >> model.switches, 0U) << "a switch that there is not";
  }
  ASSERT_LE(std::abs(reading.knob), 3277) << "more than a report can say";
  for (std::size_t i = 0; i < reading.axes.size(); ++i) {
    ASSERT_LE(std::abs(reading.axes[i]), 1000);
    if ((reading.axes_told >> i & 1U) == 0) {
      ASSERT_EQ(reading.axes[i], 0);
    }
  }
}

TEST(HidDecoder, every_report_family_has_one_and_no_other) {
  for (const ControlModel& model : listed_control_models())
    EXPECT_EQ(make_hid_decoder(model) == nullptr, model.by_evdev()) << model.name;
}

TEST(HidDecoder, what_no_device_sends_harms_nothing) {
  std::mt19937 random{tests::fresh_seed()};
  std::vector<ControlModel> models = listed_control_models();
  models.push_back({.model = "learned",
                    .name = "learned",
                    .switches = 3,
                    .bits = {{0, 0x80}, {7, 0x01}, {63, 0xff}}});
  for (const ControlModel& model : models) {
    const auto decoder = make_hid_decoder(model);
    if (!decoder)
      continue;
    int read = 0;
    for (int round = 0; round < 20'000; ++round) {
      Bytes bytes(random() % 16 == 0 ? random() % 256 : random() % 14);
      for (std::uint8_t& byte : bytes)
        byte = static_cast<std::uint8_t>(random());
      if (!bytes.empty() && random() % 2 == 0)
        bytes[0] = static_cast<std::uint8_t>(random() % 5); // an ID, or a ring near its middle
      if (const auto reading = decoder->decode(bytes)) {
        ++read;
        expect_sane(*reading, model);
      }
      ASSERT_FALSE(testing::Test::HasFatalFailure()) << model.name << ", round " << round;
    }
    EXPECT_GT(read, 20) << model.name << ": nothing was tried";
  }
}

TEST(HidDecoder, nothing_is_read_from_an_empty_report) {
  for (const ControlModel& model : listed_control_models())
    if (const auto decoder = make_hid_decoder(model)) {
      EXPECT_FALSE(decoder->decode({})) << model.name;
    }
}

TEST(PedalDecoder, takes_its_bits_and_no_others) {
  for (int bits = 0; bits < 256; ++bits) {
    const Bytes report{static_cast<std::uint8_t>(bits), 0xff};
    EXPECT_EQ(make_hid_decoder(model_of("vec_infinity"))->decode(report)->switches, bits & 7);
    EXPECT_EQ(make_hid_decoder(model_of("philips_pedal"))->decode(report)->switches, bits & 15);
  }
}

// However the wheel turns, in steps of less than half a round nothing is lost.
TEST(ShuttleDecoder, the_jog_adds_up) {
  std::mt19937 random{tests::fresh_seed()};
  const auto decoder = make_hid_decoder(model_of("shuttle_xpress"));
  int position = 77, told = 0;
  decoder->decode(Bytes{0, 77, 0, 0, 0});
  for (int i = 0; i < 5000; ++i) {
    position += static_cast<int>(random() % 255) - 127;
    told += decoder->decode(Bytes{0, static_cast<std::uint8_t>(position), 0, 0, 0})->knob;
  }
  EXPECT_EQ(told, position - 77);
}

TEST(ShuttleDecoder, knows_its_buttons_and_its_ring) {
  for (unsigned bit = 0; bit < 16; ++bit) {
    const unsigned buttons = 1U << bit;
    const Bytes report{0, 0, 0, static_cast<std::uint8_t>(buttons),
                       static_cast<std::uint8_t>(buttons >> 8U)};
    EXPECT_EQ(make_hid_decoder(model_of("shuttle_xpress"))->decode(report)->switches,
              bit >= 4 && bit < 9 ? 1U << (bit - 4) : 0U);
    EXPECT_EQ(make_hid_decoder(model_of("shuttle_pro"))->decode(report)->switches,
              bit < 15 ? 1U << bit : 0U);
  }
  const auto decoder = make_hid_decoder(model_of("shuttle_pro"));
  for (int ring = -128; ring < 128; ++ring) {
    const auto reading = decoder->decode(Bytes{static_cast<std::uint8_t>(ring), 0, 0, 0, 0});
    ASSERT_EQ(reading.has_value(), std::abs(ring) <= 7) << ring;
    if (reading) {
      EXPECT_EQ(reading->axes[5], ring * 1000 / 7);
    }
  }
}

TEST(SpaceMouseDecoder, reads_both_forms_alike) {
  std::mt19937 random{tests::fresh_seed()};
  for (int round = 0; round < 1000; ++round) {
    Bytes six{1};
    for (int i = 0; i < 12; ++i)
      six.push_back(static_cast<std::uint8_t>(random()));
    const auto decoder = make_hid_decoder(model_of("space_mouse"));
    const auto all = decoder->decode(six);
    Bytes shift{1}, turn{2};
    shift.insert(shift.end(), six.begin() + 1, six.begin() + 7);
    turn.insert(turn.end(), six.begin() + 7, six.end());
    const auto first = decoder->decode(shift);
    const auto second = decoder->decode(turn);
    ASSERT_TRUE(all && first && second);
    EXPECT_EQ(first->axes_told | second->axes_told, all->axes_told);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(all->axes[i], i < 3 ? first->axes[i] : second->axes[i]);
  }
}

TEST(SurfaceDialDecoder, counts_add_up_to_detents) {
  std::mt19937 random{tests::fresh_seed()};
  const auto decoder = make_hid_decoder(model_of("surface_dial"));
  int counts = 0, detents = 0;
  for (int i = 0; i < 5000; ++i) {
    const int step = static_cast<int>(random() % 201) - 100;
    counts += step;
    detents += decoder
                   ->decode(Bytes{1, 0, static_cast<std::uint8_t>(step),
                                  static_cast<std::uint8_t>(step >> 8), 0, 0, 0, 0})
                   ->knob;
    ASSERT_LT(std::abs(counts - 10 * detents), 10);
  }
}

TEST(MappedDecoder, takes_the_bits_that_were_learned) {
  const ControlModel model{.model = "learned",
                           .name = "learned",
                           .switches = 2,
                           .bits = {{1, 0x10}, {2, 0x01}},
                           .report_id = std::uint8_t{5}};
  const auto decoder = make_hid_decoder(model);
  EXPECT_EQ(decoder->decode(Bytes{5, 0x10, 0x00})->switches, 1U);
  EXPECT_EQ(decoder->decode(Bytes{5, 0xef, 0x01})->switches, 2U);
  EXPECT_FALSE(decoder->decode(Bytes{4, 0x10, 0x00})) << "another report";
  EXPECT_FALSE(decoder->decode(Bytes{5, 0x10})) << "too short";
}

TEST(KeyDecoder, keys_are_switches_and_repeats_are_nothing) {
  KeyDecoder triple{model_of("pcsensor_triple")};
  EXPECT_EQ(triple.decode({EV_KEY, KEY_B, 1})->switches, 2U);
  EXPECT_FALSE(triple.decode({EV_KEY, KEY_B, 2}));
  EXPECT_EQ(triple.decode({EV_KEY, KEY_C, 1})->switches, 6U);
  EXPECT_FALSE(triple.decode({EV_KEY, KEY_D, 1})) << "not one of its keys";
  EXPECT_EQ(triple.decode({EV_KEY, KEY_B, 0})->switches, 4U);
  EXPECT_FALSE(triple.decode({EV_SYN, SYN_REPORT, 0}));
}

TEST(KeyDecoder, any_key_of_a_single_pedal_holds_it_down) {
  KeyDecoder single{model_of("pcsensor_single")};
  EXPECT_FALSE(single.decode({EV_KEY, KEY_X, 0})) << "let go before it was seen going down";
  EXPECT_EQ(single.decode({EV_KEY, KEY_LEFTCTRL, 1})->switches, 1U);
  EXPECT_EQ(single.decode({EV_KEY, KEY_Z, 1})->switches, 1U);
  EXPECT_EQ(single.decode({EV_KEY, KEY_LEFTCTRL, 0})->switches, 1U);
  EXPECT_EQ(single.decode({EV_KEY, KEY_Z, 0})->switches, 0U);
}

TEST(KeyDecoder, a_powermate_turns_and_is_pressed) {
  KeyDecoder knob{model_of("powermate")};
  EXPECT_EQ(knob.decode({EV_REL, REL_DIAL, -3})->knob, -3);
  EXPECT_EQ(knob.decode({EV_KEY, BTN_0, 1})->switches, 1U);
  EXPECT_FALSE(knob.decode({EV_KEY, KEY_A, 1}));
  EXPECT_FALSE(knob.decode({EV_REL, REL_X, 5}));
}

TEST(KeyDecoder, what_no_device_sends_harms_nothing) {
  std::mt19937 random{tests::fresh_seed()};
  for (const ControlModel& model : listed_control_models()) {
    if (!model.by_evdev())
      continue;
    KeyDecoder decoder{model};
    for (int round = 0; round < 20'000; ++round) {
      const auto reading =
          decoder.decode({static_cast<std::uint16_t>(random() % 5),
                          static_cast<std::uint16_t>(random() % 2 == 0 ? random() % 64 : random()),
                          random() % 2 == 0 ? static_cast<std::int32_t>(random())
                                            : static_cast<int>(random() % 3)});
      if (reading)
        expect_sane(*reading, model);
      ASSERT_FALSE(testing::Test::HasFatalFailure()) << model.name << ", round " << round;
    }
  }
}

} // namespace
} // namespace octascope::hal::linux_backend
