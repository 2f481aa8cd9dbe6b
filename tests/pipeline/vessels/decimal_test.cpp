#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/files/decimal.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

Decimal read_whole(const std::string& text, int shift = 0) {
  const std::string line = text + "\n";
  Decimal decimal;
  const char* const end = read_decimal(line.c_str(), shift, decimal);
  if (decimal.fault == DecimalFault::none) {
    EXPECT_EQ(*end, '\n') << text;
  }
  return decimal;
}

// The standard library's, of the number with its exponent changed as text.
float reference(const std::string& digits, int exponent) {
  const std::string text = fmt::format("{}e{}", digits, exponent);
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} ? value : 0;
}

std::string written(float value, int shift) {
  char text[longest_decimal];
  return {text, write_decimal(text, value, shift)};
}

TEST(Decimal, reads_what_people_write) {
  EXPECT_EQ(read_whole("0").value, 0.0F);
  EXPECT_EQ(read_whole("-12.5").value, -12.5F);
  EXPECT_EQ(read_whole("+3").value, 3.0F);
  EXPECT_EQ(read_whole(".5").value, 0.5F);
  EXPECT_EQ(read_whole("5.").value, 5.0F);
  EXPECT_EQ(read_whole("1.5e2").value, 150.0F);
  EXPECT_EQ(read_whole("1.5E-2").value, 0.015F);
  EXPECT_EQ(read_whole("1234.5", -3).value, 1.2345F);
  EXPECT_EQ(read_whole("00000000000000000000000012", 0).value, 12.0F);
  EXPECT_EQ(read_whole("0.1000000000000000000000000000000000001").value, 0.1F);
  EXPECT_EQ(read_whole("1e-60").value, 0.0F);
  EXPECT_EQ(read_whole("0e99999999999999999999").value, 0.0F);
  EXPECT_TRUE(std::signbit(read_whole("-0").value));
}

TEST(Decimal, refuses_what_is_no_number_of_a_float) {
  for (const char* text : {"", "-", ".", "e5", "nan", "inf", "-inf", "x", "--1", "+-1"})
    EXPECT_EQ(read_whole(text).fault, DecimalFault::no_number) << text;
  for (const char* text :
       {"1e39", "-1e39", "1e999999999999", "340282400000000000000000000000000000000"})
    EXPECT_EQ(read_whole(text).fault, DecimalFault::too_large) << text;
}

TEST(Decimal, ends_at_what_belongs_to_no_number) {
  Decimal decimal;
  const std::string text = "1.5e+ 2\n";
  EXPECT_EQ(read_decimal(text.c_str(), 0, decimal) - text.c_str(), 3); // at the e
  EXPECT_EQ(decimal.value, 1.5F);
}

// Whatever way is taken inside: the float is the one next to the decimal number.
TEST(Decimal, rounds_once) {
  std::mt19937_64 random{tests::fresh_seed()};
  for (int round = 0; round < 300'000; ++round) {
    std::string digits = std::to_string(random() >> (random() % 60));
    const int decimals = static_cast<int>(random() % (digits.size() + 1));
    const int exponent = static_cast<int>(random() % 80) - 45;
    const int shift = static_cast<int>(random() % 7) - 3;
    const std::size_t whole = digits.size() - static_cast<std::size_t>(decimals);
    digits = fmt::format("{}.{}", digits.substr(0, whole), digits.substr(whole));
    const Decimal decimal = read_whole(fmt::format("{}e{}", digits, exponent), shift);
    if (decimal.fault == DecimalFault::none) {
      ASSERT_EQ(decimal.value, reference(digits, exponent + shift)) << digits << "e" << exponent;
    }
  }
}

// The middle between two floats, and a hair beside it: a double in between would round wrongly.
TEST(Decimal, rounds_once_around_the_middle_of_two_floats) {
  for (const char* digits :
       {"16777217", "16777217.000000000000000000001", "16777216.999999999999999999",
        "1.00000005960464477539062500", "1.000000059604644775390625000000000001",
        "1.000000059604644775390624999999999999"})
    EXPECT_EQ(read_whole(digits).value, reference(digits, 0)) << digits;
}

TEST(Decimal, reads_back_every_float_that_it_writes) {
  std::mt19937_64 random{tests::fresh_seed()};
  for (int round = 0; round < 300'000; ++round) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(value))
      continue;
    for (const int shift : {0, 3}) {
      const std::string text = written(value, shift);
      ASSERT_LE(text.size(), static_cast<std::size_t>(longest_decimal));
      ASSERT_EQ(read_whole(text, -shift).value, value) << text;
    }
  }
}

TEST(Decimal, writes_the_shortest) {
  EXPECT_EQ(written(0.1F, 0), "0.1");
  EXPECT_EQ(written(0.1F, 3), "100");
  EXPECT_EQ(written(-12.345F, 3), "-12345");
  EXPECT_EQ(written(-0.0F, 3), "-0");
  EXPECT_EQ(written(0.0045F, 3), "4.5");
  EXPECT_EQ(written(1.5e-6F, 3), "0.0015");
  EXPECT_EQ(written(1e-20F, 0), "1e-20");
  EXPECT_EQ(written(std::numeric_limits<float>::max(), 0), "3.4028235e38");
}

} // namespace
} // namespace octascope::pipeline
