#include "pipeline/vessels/files/decimal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>
#include <string>
#include <system_error>

namespace octascope::pipeline {
namespace {

// Powers of ten that a double holds exactly.
constexpr std::array<double, 23> powers_of_ten{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                               1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                               1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
constexpr int largest_exact_power = static_cast<int>(powers_of_ten.size()) - 1;
constexpr std::uint64_t largest_exact_digits = std::uint64_t{1} << 53;
constexpr int longest_digits = 19; // that always fit into 64 bits

constexpr bool is_digit(char c) {
  return static_cast<unsigned char>(c - '0') < 10;
}

struct Scan {
  const char* digits = nullptr; // behind the sign
  const char* digits_end = nullptr;
  std::uint64_t value = 0;
  int count = 0;    // of digits from the first that is not 0
  int exponent = 0; // of the last digit
  bool negative = false;
};

const char* scan_exponent(const char* at, int& exponent) {
  const char* digit = at + 1;
  const bool negative = *digit == '-';
  if (negative || *digit == '+')
    ++digit;
  if (!is_digit(*digit))
    return at; // an 'e' that belongs to nothing: the caller finds it behind the number
  constexpr int beyond_all = 1'000'000; // floats end at 10^39
  int value = 0;
  for (; is_digit(*digit); ++digit)
    value = std::min(10 * value + (*digit - '0'), beyond_all);
  exponent += negative ? -value : value;
  return digit;
}

const char* scan_number(const char* at, Scan& scan) {
  scan.negative = *at == '-';
  if (scan.negative || *at == '+')
    ++at;
  scan.digits = at;
  bool any = false;
  const auto take = [&] {
    for (; is_digit(*at); ++at) {
      any = true;
      scan.value = 10 * scan.value + static_cast<std::uint64_t>(*at - '0');
      scan.count += scan.count > 0 || *at != '0' ? 1 : 0;
    }
  };
  take();
  if (*at == '.') {
    const char* const first = ++at;
    take();
    scan.exponent = -static_cast<int>(at - first);
  }
  scan.digits_end = at;
  if (!any)
    return nullptr;
  if (*at == 'e' || *at == 'E')
    at = scan_exponent(at, scan.exponent);
  return at;
}

// For what the quick way cannot round with certainty.
Decimal read_slowly(const Scan& scan, int shift) {
  const auto point = std::find(scan.digits, scan.digits_end, '.');
  const auto decimals =
      point == scan.digits_end ? 0 : static_cast<int>(scan.digits_end - point) - 1;
  const std::string text = std::string(scan.digits, scan.digits_end) + "e" +
                           std::to_string(scan.exponent + decimals + shift);
  Decimal decimal;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), decimal.value);
  if (error == std::errc::result_out_of_range) {
    const int leading = scan.count - 1 + scan.exponent + shift; // exponent of the first digit
    decimal.value = 0;
    decimal.fault = leading < 0 ? DecimalFault::none : DecimalFault::too_large;
  } else if (error != std::errc{}) {
    decimal.fault = DecimalFault::no_number;
  }
  return decimal;
}

// Both operands are exact, so that the double is the one nearest to the number; and unless it lies
// in the middle between two floats, the float nearest to it is the one nearest to the number.
bool read_quickly(const Scan& scan, int shift, float& value) {
  const int power = scan.exponent + shift;
  if (scan.count > longest_digits || scan.value > largest_exact_digits ||
      power < -largest_exact_power || power > largest_exact_power)
    return false;
  const auto digits = static_cast<double>(scan.value);
  const double number = power < 0 ? digits / powers_of_ten[static_cast<std::size_t>(-power)]
                                  : digits * powers_of_ten[static_cast<std::size_t>(power)];
  constexpr std::uint64_t dropped_bits = (std::uint64_t{1} << 29) - 1;
  constexpr std::uint64_t middle = std::uint64_t{1} << 28;
  const bool certain = (std::bit_cast<std::uint64_t>(number) & dropped_bits) != middle &&
                       number >= static_cast<double>(std::numeric_limits<float>::min()) &&
                       number <= static_cast<double>(std::numeric_limits<float>::max());
  if (!certain && number != 0)
    return false;
  value = static_cast<float>(number);
  return true;
}

} // namespace

const char* read_decimal(const char* text, int shift, Decimal& decimal) {
  Scan scan;
  const char* const end = scan_number(text, scan);
  if (end == nullptr) {
    decimal = {0, DecimalFault::no_number};
    return text;
  }
  decimal.fault = DecimalFault::none;
  if (!read_quickly(scan, shift, decimal.value))
    decimal = read_slowly(scan, shift);
  if (scan.negative)
    decimal.value = -decimal.value;
  return end;
}

char* write_decimal(char* out, float value, int shift) {
  // d.ddde±xx
  std::array<char, longest_decimal> text{};
  const char* const text_end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific)
          .ptr;
  const char* at = text.data();
  if (*at == '-')
    *out++ = *at++;
  std::array<char, longest_decimal> digits{};
  int count = 0;
  for (; *at != 'e'; ++at) {
    if (*at != '.')
      digits[static_cast<std::size_t>(count++)] = *at;
  }
  if (count == 1 && digits[0] == '0') {
    *out++ = '0';
    return out;
  }
  int exponent = 0;
  ++at;
  std::from_chars(at + (*at == '+' ? 1 : 0), text_end, exponent);
  exponent += shift;
  const auto copy = [&](int from, int to) {
    out = std::copy(digits.begin() + from, digits.begin() + to, out);
  };
  constexpr int smallest_plain = -5;
  constexpr int largest_plain = 9;
  if (exponent < smallest_plain || exponent > largest_plain) {
    copy(0, 1);
    if (count > 1)
      *out++ = '.';
    copy(1, count);
    *out++ = 'e';
    return std::to_chars(out, out + 8, exponent).ptr;
  }
  if (exponent < 0) {
    *out++ = '0';
    *out++ = '.';
    out = std::fill_n(out, -exponent - 1, '0');
    copy(0, count);
    return out;
  }
  const int whole = std::min(count, exponent + 1);
  copy(0, whole);
  out = std::fill_n(out, exponent + 1 - whole, '0');
  if (count > whole) {
    *out++ = '.';
    copy(whole, count);
  }
  return out;
}

} // namespace octascope::pipeline
