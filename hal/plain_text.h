// Text from outside (files, options, devices) may hold control characters, which move a terminal's
// cursor or forge a line, and bytes that are not UTF-8, which spoil the document they get into.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace octascope::hal {

// The bytes of the character that the text begins with; 0 where it begins with none of UTF-8
// (RFC 3629).
std::size_t utf8_character_length(std::string_view text);

// Whether a character is one of U+0000 to U+001F and U+007F to U+009F.
bool is_control_character(std::string_view character);

// Whether the text is UTF-8 without control characters.
bool is_plain_text(std::string_view text);

// A plain text of the same length or shorter: each control character, and each byte that is not
// part of a character, becomes "?".
std::string printable(std::string_view text);

// Likewise, with what is longer than so many bytes cut between two characters and ended by "…": for
// messages that quote it.
std::string shortened(std::string_view text, std::size_t most = 40);

// Like printable(), for what consists of lines: keeps tabs and line ends.
std::string printable_lines(std::string_view text);

} // namespace octascope::hal
