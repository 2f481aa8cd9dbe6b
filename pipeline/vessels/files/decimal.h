// Numbers as text, to and from float, with the decimal point moved on the way: a file in
// micrometres becomes millimetres, and comes back, without the rounding of a multiplication.
//
// Independent of the locale. Reading rounds once, to the float nearest to the decimal number;
// writing gives the shortest digits that read back as the same float (std::to_chars).
#pragma once

#include <cstdint>

namespace octascope::pipeline {

enum class DecimalFault : std::uint8_t {
  none,
  no_number, // nan and inf are none either
  too_large, // for a float
};

struct Decimal {
  float value = 0;
  DecimalFault fault = DecimalFault::none;
};

// Takes an optional sign, digits with or without a point, an optional exponent; gives the first
// character that does not belong to them. `decimal.value` is the number times 10^shift; what is
// closer to zero than every float is zero. The text must hold a character that belongs to no number
// (the end of a line): there the reading ends.
const char* read_decimal(const char* text, int shift, Decimal& decimal);

// `value` must be finite, `out` have room for longest_decimal. Writes value · 10^shift, gives the
// end. read_decimal() with −shift gives `value` back.
inline constexpr int longest_decimal = 32;
char* write_decimal(char* out, float value, int shift);

} // namespace octascope::pipeline
