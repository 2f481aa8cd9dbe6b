// Whatever a driver lists and answers: a request that may be sent, or words. Good lists changed at
// random, anew in every run; each answer is checked against a second reading of the rules.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "hal/linux/v4l2/format_negotiation.h"
#include "hal/linux/v4l2/pixel_formats.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

class Mutations {
public:
  explicit Mutations(unsigned seed) : random_{seed} {}

  std::uint32_t number() {
    constexpr std::uint32_t awkward[] = {
        0,      1,       2,    378,  379,    380,     1023,        1024,        1025,       2048,
        0xFFFF, 0x10000, 4096, 2112, 776192, 1 << 20, 0x7FFF'FFFF, 0x8000'0000, 0xFFFF'FFFF};
    if (random_() % 4 == 0)
      return static_cast<std::uint32_t>(random_());
    return awkward[random_() % std::size(awkward)];
  }

  std::uint32_t code() {
    constexpr std::string_view letters = "GREYUV0124 P\0\x7F\xFF";
    switch (random_() % 3) {
    case 0: return line_pixel_formats()[random_() % line_pixel_formats().size()].code;
    case 1:
      return line_pixel_formats()[random_() % line_pixel_formats().size()].code ^
             1U << random_() % 32;
    default: {
      const auto letter = [&] { return letters[random_() % letters.size()]; };
      return fourcc(letter(), letter(), letter(), letter());
    }
    }
  }

  std::vector<OfferedFormat> offer() {
    std::vector<OfferedFormat> formats(random_() % 6);
    for (OfferedFormat& format : formats) {
      format.code = code();
      format.sizes.resize(random_() % 4);
      for (OfferedSize& size : format.sizes)
        size = {{number(), number(), number()}, {number(), number(), number()}};
    }
    return formats;
  }

  LineFormat wanted() {
    LineFormat format;
    format.sample_type = random_() % 3 == 0 ? SampleType::u8 : SampleType::u16;
    format.significant_bits = 8 + static_cast<int>(random_() % 9);
    if (random_() % 4 == 0)
      format.right_shift = static_cast<int>(random_() % 9) - 1;
    if (random_() % 8 == 0)
      format.samples_per_line = static_cast<int>(number());
    if (random_() % 8 == 0)
      format.lines_per_frame = static_cast<int>(number());
    if (random_() % 8 == 0)
      format.significant_bits = static_cast<int>(number());
    return format;
  }

  // What was asked for, with a change or two.
  GivenFormat answer(const FormatRequest& asked) {
    GivenFormat given{asked.code, asked.width, asked.height, asked.bytes_per_line, 0, 1};
    given.image_bytes = asked.bytes_per_line * asked.height;
    std::uint32_t* const fields[] = {&given.code,           &given.width,       &given.height,
                                     &given.bytes_per_line, &given.image_bytes, &given.field};
    for (auto changes = random_() % 3; changes > 0; --changes)
      *fields[random_() % std::size(fields)] = number();
    return given;
  }

private:
  std::mt19937_64 random_;
};

void expect_words(const Error& error) {
  ASSERT_GT(error.message.size(), 20U);
  ASSERT_LT(error.message.size(), 2000U);
  ASSERT_NE(error.message.find("expected"), std::string::npos) << error.message;
  ASSERT_TRUE(std::ranges::none_of(error.message, [](unsigned char c) { return c < ' '; }));
}

TEST(MutatedFormats, give_a_request_or_words) {
  Mutations mutations{tests::fresh_seed()};
  int accepted = 0;
  int refused = 0;
  for (int round = 0; round < 50'000; ++round) {
    const auto offered = mutations.offer();
    const LineFormat wanted = mutations.wanted();
    const auto ranked = rank_formats(offered, wanted);
    if (!ranked) {
      ++refused;
      ASSERT_TRUE(ranked.error().code == ErrorCode::absent ||
                  ranked.error().code == ErrorCode::unsupported ||
                  ranked.error().code == ErrorCode::invalid_argument);
      if (ranked.error().code != ErrorCode::absent)
        expect_words(ranked.error());
      continue;
    }
    ++accepted;
    ASSERT_FALSE(ranked->empty());
    for (const FormatRequest& request : *ranked) {
      ASSERT_TRUE(std::ranges::any_of(
          offered, [&](const OfferedFormat& format) { return format.code == request.code; }));
      ASSERT_EQ(request.code & big_endian_mark, 0U);
      ASSERT_EQ(request.width, static_cast<std::uint32_t>(wanted.samples_per_line));
      ASSERT_EQ(request.height, static_cast<std::uint32_t>(wanted.lines_per_frame));
      ASSERT_EQ(request.bytes_per_line, wanted.line_bytes());
      const GivenFormat given = mutations.answer(request);
      if (const auto checked = check_given(request, given); !checked) {
        expect_words(checked.error());
      } else { // then every sample lies where it is read
        ASSERT_EQ(given.code, request.code);
        ASSERT_EQ(given.bytes_per_line, wanted.line_bytes());
        ASSERT_EQ(given.height, request.height);
        ASSERT_GE(given.image_bytes, wanted.frame_bytes());
        ASSERT_LE(given.field, 1U);
      }
    }
    if (HasFatalFailure())
      return;
  }
  EXPECT_GT(accepted, 500);
  EXPECT_GT(refused, 5000);
}

} // namespace
} // namespace octascope::hal::linux_backend
