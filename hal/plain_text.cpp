#include "hal/plain_text.h"

namespace octascope::hal {

namespace {

// keep(the text from a control character on): whether the character stays.
template <class Keep> std::string replaced(std::string_view text, Keep keep) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_character_length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    if (length > 0 && (!is_control_character(character) || keep(text)))
      out += character;
    else
      out += '?';
    text.remove_prefix(character.size());
  }
  return out;
}

} // namespace

std::size_t utf8_character_length(std::string_view text) {
  if (text.empty())
    return 0;
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length > text.size())
    return 0;
  for (const char c : text.substr(1, length == 0 ? 0 : length - 1)) {
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80)
      return 0;
  }
  // Longer than need be, half of a pair, or beyond the last character.
  const auto second = static_cast<unsigned char>(text.size() > 1 ? text[1] : 0);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool no_character = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || no_character ? 0 : length;
}

bool is_control_character(std::string_view character) {
  const auto first = static_cast<unsigned char>(character.front());
  return first < 0x20 || first == 0x7F ||
         (first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

bool is_plain_text(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_character_length(text);
    if (length == 0 || is_control_character(text.substr(0, length)))
      return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string printable(std::string_view text) {
  return replaced(text, [](std::string_view) { return false; });
}

std::string shortened(std::string_view text, std::size_t most) {
  std::string out = printable(text);
  if (out.size() <= most)
    return out;
  while (most > 0 && (static_cast<unsigned char>(out[most]) & 0xC0U) == 0x80U)
    --most;
  return out.substr(0, most) + "…";
}

std::string printable_lines(std::string_view text) {
  return replaced(text, [](std::string_view from) {
    return from.front() == '\n' || from.front() == '\t' || from.starts_with("\r\n");
  });
}

} // namespace octascope::hal
