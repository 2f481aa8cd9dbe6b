// From a keyboard's events to keys.
#include <map>

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "hal/linux/hid/keyboards/keyboard_decoder.h"

namespace octascope::hal::linux_backend {
namespace {

using enum DisplayEventKind;

constexpr std::int32_t up = 0, down = 1, held = 2;

class KeyboardDecoderTest : public testing::Test {
protected:
  std::optional<DisplayEvent> key(std::uint16_t code, std::int32_t value) {
    return decoder_.decode({EV_KEY, code, value}, now_);
  }

  KeyboardDecoder decoder_;
  TimePoint now_{std::chrono::seconds{7}};
};

// Names from the kernel's list of codes, one by one.
TEST(KeysOfKeyboard, are_those_that_are_printed_on_them) {
  const std::map<std::uint16_t, char> printed{
      {KEY_0, '0'},     {KEY_1, '1'},           {KEY_2, '2'},          {KEY_3, '3'},
      {KEY_9, '9'},     {KEY_A, 'a'},           {KEY_B, 'b'},          {KEY_C, 'c'},
      {KEY_D, 'd'},     {KEY_E, 'e'},           {KEY_F, 'f'},          {KEY_G, 'g'},
      {KEY_H, 'h'},     {KEY_I, 'i'},           {KEY_J, 'j'},          {KEY_K, 'k'},
      {KEY_L, 'l'},     {KEY_M, 'm'},           {KEY_N, 'n'},          {KEY_O, 'o'},
      {KEY_P, 'p'},     {KEY_Q, 'q'},           {KEY_R, 'r'},          {KEY_S, 's'},
      {KEY_T, 't'},     {KEY_U, 'u'},           {KEY_V, 'v'},          {KEY_W, 'w'},
      {KEY_X, 'x'},     {KEY_Y, 'y'},           {KEY_Z, 'z'},          {KEY_MINUS, '-'},
      {KEY_EQUAL, '='}, {KEY_LEFTBRACE, '['},   {KEY_RIGHTBRACE, ']'}, {KEY_SEMICOLON, ';'},
      {KEY_GRAVE, '`'}, {KEY_APOSTROPHE, '\''}, {KEY_BACKSLASH, '\\'}, {KEY_COMMA, ','},
      {KEY_DOT, '.'},   {KEY_SLASH, '/'},       {KEY_SPACE, ' '},      {KEY_KPPLUS, '+'},
  };
  for (const auto& [code, character] : printed)
    EXPECT_EQ(key_of_keyboard(code), character) << code;
}

TEST(KeysOfKeyboard, without_a_letter_have_names) {
  const std::map<std::uint16_t, Key> named{
      {KEY_ESC, Key::escape},
      {KEY_LEFT, Key::left},
      {KEY_RIGHT, Key::right},
      {KEY_UP, Key::up},
      {KEY_DOWN, Key::down},
      {KEY_PAGEUP, Key::page_up},
      {KEY_PAGEDOWN, Key::page_down},
      {KEY_HOME, Key::home},
      {KEY_END, Key::end},
      {KEY_TAB, Key::tab},
      {KEY_ENTER, Key::enter},
      {KEY_F1, Key::f1},
  };
  for (const auto& [code, name] : named)
    EXPECT_EQ(key_of_keyboard(code), static_cast<std::uint16_t>(name)) << code;
  for (const int code :
       {KEY_RESERVED, KEY_LEFTSHIFT, KEY_LEFTCTRL, KEY_F2, KEY_SYSRQ, KEY_POWER, KEY_MAX, BTN_LEFT})
    EXPECT_EQ(key_of_keyboard(static_cast<std::uint16_t>(code)), 0) << code;
}

TEST_F(KeyboardDecoderTest, a_key_is_pressed_repeated_and_released) {
  const auto pressed = key(KEY_O, down);
  ASSERT_TRUE(pressed);
  EXPECT_EQ(pressed->kind, key_pressed);
  EXPECT_EQ(pressed->key, 'o');
  EXPECT_FALSE(pressed->repeated);
  EXPECT_FALSE(pressed->shift);
  EXPECT_EQ(pressed->time, now_);
  const auto repeated = key(KEY_O, held);
  ASSERT_TRUE(repeated);
  EXPECT_EQ(repeated->kind, key_pressed);
  EXPECT_TRUE(repeated->repeated);
  const auto released = key(KEY_O, up);
  ASSERT_TRUE(released);
  EXPECT_EQ(released->kind, key_released);
}

TEST_F(KeyboardDecoderTest, either_shift_counts_while_it_is_down) {
  EXPECT_FALSE(key(KEY_LEFTSHIFT, down)) << "means nothing by itself";
  EXPECT_TRUE(key(KEY_T, down).value().shift);
  key(KEY_RIGHTSHIFT, down);
  key(KEY_LEFTSHIFT, up);
  EXPECT_TRUE(key(KEY_O, down).value().shift);
  key(KEY_RIGHTSHIFT, up);
  EXPECT_FALSE(key(KEY_S, down).value().shift);
}

TEST_F(KeyboardDecoderTest, what_was_pressed_before_it_listened_is_not_told) {
  EXPECT_FALSE(key(KEY_Q, held));
  EXPECT_FALSE(key(KEY_Q, up));
  EXPECT_TRUE(key(KEY_Q, down));
  EXPECT_FALSE(key(KEY_Q, down)) << "twice";
}

TEST_F(KeyboardDecoderTest, strange_events_say_nothing) {
  EXPECT_FALSE(key(KEY_A, 3));
  EXPECT_FALSE(key(KEY_A, -1));
  EXPECT_FALSE(key(KEY_MAX, down));
  EXPECT_FALSE(key(0xffff, down));
  EXPECT_FALSE(decoder_.decode({EV_REL, KEY_A, 1}, now_));
  EXPECT_FALSE(decoder_.decode({EV_SYN, 0, 0}, now_));
}

TEST_F(KeyboardDecoderTest, everything_that_is_down_can_be_let_go) {
  for (const int code : {KEY_LEFTSHIFT, KEY_1, KEY_UP})
    key(static_cast<std::uint16_t>(code), down);
  std::vector<std::uint16_t> released;
  while (const auto told = decoder_.release_one(now_)) {
    EXPECT_EQ(told->kind, key_released);
    released.push_back(told->key);
  }
  EXPECT_EQ(released, (std::vector<std::uint16_t>{'1', static_cast<std::uint16_t>(Key::up)}));
  EXPECT_FALSE(key(KEY_1, up)) << "it was";
  EXPECT_FALSE(key(KEY_T, down).value().shift);
}

} // namespace
} // namespace octascope::hal::linux_backend
