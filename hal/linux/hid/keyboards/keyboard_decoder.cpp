#include "hal/linux/hid/keyboards/keyboard_decoder.h"

#include <string_view>

#include <linux/input-event-codes.h>

namespace octascope::hal::linux_backend {

namespace {

constexpr std::int32_t released = 0, pressed = 1, repeated = 2;

// Rows of keys that have consecutive codes.
struct Row {
  std::uint16_t first;
  std::string_view keys;
};
constexpr Row rows[]{{KEY_1, "1234567890-="},
                     {KEY_Q, "qwertyuiop[]"},
                     {KEY_A, "asdfghjkl;'`"},
                     {KEY_BACKSLASH, "\\zxcvbnm,./"}};

constexpr std::uint16_t code(Key key) {
  return static_cast<std::uint16_t>(key);
}

} // namespace

std::uint16_t key_of_keyboard(std::uint16_t from) {
  switch (from) {
  case KEY_ESC: return code(Key::escape);
  case KEY_SPACE: return code(Key::space);
  case KEY_LEFT: return code(Key::left);
  case KEY_RIGHT: return code(Key::right);
  case KEY_UP: return code(Key::up);
  case KEY_DOWN: return code(Key::down);
  case KEY_PAGEUP: return code(Key::page_up);
  case KEY_PAGEDOWN: return code(Key::page_down);
  case KEY_HOME: return code(Key::home);
  case KEY_END: return code(Key::end);
  case KEY_TAB: return code(Key::tab);
  case KEY_ENTER:
  case KEY_KPENTER: return code(Key::enter);
  case KEY_F1: return code(Key::f1);
  case KEY_KPPLUS: return '+';
  case KEY_KPMINUS: return '-';
  default: break;
  }
  for (const Row& row : rows)
    if (from >= row.first && from < row.first + row.keys.size())
      return static_cast<unsigned char>(row.keys[from - row.first]);
  return 0;
}

std::optional<DisplayEvent> KeyboardDecoder::decode(const KeyEvent& event, TimePoint time) {
  if (event.type != EV_KEY || event.code >= most_codes || event.value < released ||
      event.value > repeated)
    return std::nullopt;
  const bool was_down = down_[event.code];
  if ((event.value == pressed) == was_down) // its beginning was not heard, or told already
    return std::nullopt;
  down_[event.code] = event.value != released;
  DisplayEvent told;
  told.kind =
      event.value == released ? DisplayEventKind::key_released : DisplayEventKind::key_pressed;
  told.key = key_of_keyboard(event.code);
  told.repeated = event.value == repeated;
  told.shift = down_[KEY_LEFTSHIFT] || down_[KEY_RIGHTSHIFT];
  told.time = time;
  return told.key != 0 ? std::optional{told} : std::nullopt;
}

std::optional<DisplayEvent> KeyboardDecoder::release_one(TimePoint time) {
  for (std::uint16_t key = 0; key < most_codes; ++key)
    if (down_[key])
      if (const auto told = decode({EV_KEY, key, released}, time))
        return told;
  return std::nullopt;
}

} // namespace octascope::hal::linux_backend
