// Text from outside (files, options, devices) may hold control characters, which move a terminal's
// cursor or forge a line, and bytes that are not UTF-8, which spoil the document they get into.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace octascope::hal {

// The length in bytes of the first character; 0 if the text does not begin with one of UTF-8
// (RFC 3629).
std::size_t utf8_character_length(std::string_view text);

// Whether a character is one of U+0000 to U+001F and U+007F to U+009F.
bool is_control_character(std::string_view character);

// Whether the text is UTF-8 without control characters.
bool is_plain_text(std::string_view text);

// The text with "?" for each control character and for each byte that is not part of a character:
// no longer than before.
std::string printable(std::string_view text);

// Like printable(), but cut between two characters, with "…" at its end, if it is longer than
// `most` bytes: for messages that quote it.
std::string shortened(std::string_view text, std::size_t most = 40);

// Like printable(), but keeps tabs and line ends.
std::string printable_lines(std::string_view text);

} // namespace octascope::hal
