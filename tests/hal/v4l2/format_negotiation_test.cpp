#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/v4l2/format_negotiation.h"
#include "hal/linux/v4l2/pixel_formats.h"
#include "tests/support/fails_with.h"

namespace octascope::hal::linux_backend {
namespace {

using testing::HasSubstr;
using tests::FailsSaying;
using tests::FailsWith;

constexpr auto grey = fourcc('G', 'R', 'E', 'Y');
constexpr auto y10 = fourcc('Y', '1', '0', ' ');
constexpr auto y12 = fourcc('Y', '1', '2', ' ');
constexpr auto y14 = fourcc('Y', '1', '4', ' ');
constexpr auto y16 = fourcc('Y', '1', '6', ' ');
constexpr auto y16_be = y16 | big_endian_mark;
constexpr auto y10_packed = fourcc('Y', '1', '0', 'P');
constexpr auto yuyv = fourcc('Y', 'U', 'Y', 'V');

LineFormat wanted(SampleType type, int bits, int shift = 0) {
  return {.samples_per_line = 1024,
          .lines_per_frame = 379,
          .sample_type = type,
          .significant_bits = bits,
          .right_shift = shift};
}

OfferedFormat of_size(std::uint32_t code, std::uint32_t width, std::uint32_t height) {
  return {code, {{{width, width, 1}, {height, height, 1}}}};
}

OfferedFormat between(std::uint32_t code, std::uint32_t least, std::uint32_t most,
                      std::uint32_t step) {
  return {code, {{{least, most, step}, {least, most, step}}}};
}

std::vector<std::uint32_t> chosen(const std::vector<OfferedFormat>& offered,
                                  const LineFormat& format) {
  const auto ranked = rank_formats(offered, format);
  std::vector<std::uint32_t> codes;
  for (const FormatRequest& request : ranked.value_or(std::vector<FormatRequest>{}))
    codes.push_back(request.code);
  return codes;
}

struct Row {
  const char* why;
  std::vector<std::uint32_t> offered;
  SampleType type;
  int bits, shift;
  std::vector<std::uint32_t> chosen; // best first
};

TEST(FormatNegotiation, chooses_the_format_that_holds_the_samples) {
  constexpr auto u8 = SampleType::u8;
  constexpr auto u16 = SampleType::u16;
  const std::vector<std::uint32_t> all{yuyv, grey, y10, y12, y14, y16, y16_be, y10_packed};
  const Row rows[] = {
      {"eight bits", all, u8, 8, 0, {grey}},
      {"ten bits, named before a roomy one", all, u16, 10, 0, {y10, y16}},
      {"twelve bits", all, u16, 12, 0, {y12, y16}},
      {"whichever comes first", {y16, y12}, u16, 12, 0, {y12, y16}},
      {"fourteen bits", all, u16, 14, 0, {y14, y16}},
      {"sixteen bits", all, u16, 16, 0, {y16}},
      {"left-justified twelve", all, u16, 12, 4, {y16}},
      {"eleven bits have no name of their own", all, u16, 11, 0, {y16}},
      {"fewer bits in a byte", all, u8, 6, 0, {grey}},
      {"full scale of ten bits is not that of twelve", {y12}, u16, 10, 0, {}},
      {"nor that of twelve that of ten", {y10}, u16, 12, 0, {}},
      {"bytes are no words", {grey}, u16, 8, 0, {}},
      {"words are no bytes", {y16}, u8, 8, 0, {}},
      {"big-endian", {y16_be}, u16, 16, 0, {}},
      {"packed", {y10_packed}, u16, 10, 0, {}},
      {"colour", {yuyv}, u16, 12, 0, {}},
  };
  for (const Row& row : rows) {
    std::vector<OfferedFormat> offered;
    for (const std::uint32_t code : row.offered)
      offered.push_back({code, {}});
    EXPECT_EQ(chosen(offered, wanted(row.type, row.bits, row.shift)), row.chosen) << row.why;
  }
}

TEST(FormatNegotiation, a_request_is_samples_by_lines_without_padding) {
  const auto ranked =
      rank_formats(std::vector{OfferedFormat{y12, {}}}, wanted(SampleType::u16, 12));
  ASSERT_TRUE(ranked);
  EXPECT_EQ(ranked->front(), (FormatRequest{y12, 1024, 379, 2048}));
}

TEST(FormatNegotiation, sizes_decide) {
  const auto format = wanted(SampleType::u16, 12);
  EXPECT_EQ(chosen({of_size(y12, 1024, 379)}, format).size(), 1U);
  EXPECT_EQ(chosen({of_size(y12, 1024, 380)}, format).size(), 0U);
  EXPECT_EQ(chosen({between(y12, 16, 4096, 1)}, format).size(), 1U);
  EXPECT_EQ(chosen({between(y12, 16, 1023, 1)}, format).size(), 0U);
  EXPECT_EQ(chosen({between(y12, 400, 4096, 1)}, format).size(), 0U) << "too few lines";
  EXPECT_EQ(chosen({between(y12, 16, 4096, 2)}, format).size(), 1U) << "steps are asked for";
  EXPECT_EQ(chosen({of_size(y12, 640, 480), between(y16, 16, 4096, 1)}, format), std::vector{y16})
      << "a roomy format of the right size before a neat one of the wrong";
}

TEST(FormatNegotiation, refusals_have_found_and_expected) {
  const auto format = wanted(SampleType::u16, 12);
  EXPECT_THAT(rank_formats({}, format), FailsWith(ErrorCode::absent));
  const auto wrong =
      rank_formats(std::vector{of_size(y12, 640, 480), OfferedFormat{yuyv, {}}}, format);
  ASSERT_THAT(wrong, FailsWith(ErrorCode::unsupported));
  EXPECT_EQ(wrong.error().message,
            "it offers Y12 640×480 and 1 other formats; expected Y12 or Y16 at 1024×379 pixels "
            "(379 lines of 1024 samples, 12 bits in u16, shift 0)");
  EXPECT_THAT(rank_formats(std::vector{OfferedFormat{y16_be, {}}}, format),
              FailsSaying("Y16 (big-endian) has big-endian samples, expected "
                          "little-endian ones"));
  EXPECT_THAT(rank_formats(std::vector{OfferedFormat{y10_packed, {}}}, format),
              FailsSaying("Y10P has packed samples"));
}

TEST(FormatNegotiation, impossible_requests_are_the_callers_fault) {
  const auto refused = [](auto change) {
    LineFormat format = wanted(SampleType::u16, 12);
    change(format);
    EXPECT_THAT(check_request(format), FailsWith(ErrorCode::invalid_argument, "expected"));
  };
  refused([](LineFormat& f) { f.sample_type = SampleType::f32; });
  refused([](LineFormat& f) { f.samples_per_line = 0; });
  refused([](LineFormat& f) { f.samples_per_line = -1024; });
  refused([](LineFormat& f) { f.lines_per_frame = 0; });
  refused([](LineFormat& f) { f.significant_bits = 0; });
  refused([](LineFormat& f) { f.significant_bits = 17; });
  refused([](LineFormat& f) { f.right_shift = -1; });
  refused([](LineFormat& f) { f.right_shift = 5; });
  refused([](LineFormat& f) { f.right_shift = INT32_MAX; });
  refused([](LineFormat& f) { f.samples_per_line = f.lines_per_frame = INT32_MAX; });
  EXPECT_TRUE(check_request(wanted(SampleType::u16, 12, 4)));
}

TEST(FormatNegotiation, what_the_driver_gave_is_checked) {
  const FormatRequest asked{y12, 1024, 379, 2048};
  const GivenFormat good{y12, 1024, 379, 2048, 2048 * 379, 1};
  EXPECT_TRUE(check_given(asked, good));
  const auto refused = [&](auto change, const char* words) {
    GivenFormat given = good;
    change(given);
    EXPECT_THAT(check_given(asked, given), FailsWith(ErrorCode::unsupported, words));
  };
  refused([](GivenFormat& g) { g.code = yuyv; }, "YUYV, expected Y12");
  refused([](GivenFormat& g) { g.width = 1280; }, "1280×379 pixels, expected 1024×379");
  refused([](GivenFormat& g) { g.height = 380; }, "1024×380 pixels, expected 1024×379");
  refused([](GivenFormat& g) { g.bytes_per_line = 2112; }, "lines of 2112 bytes, expected 2048");
  refused([](GivenFormat& g) { g.bytes_per_line = 1536; }, "lines of 1536 bytes, expected 2048");
  refused([](GivenFormat& g) { g.image_bytes -= 1; }, "pictures of 776191 bytes");
  refused([](GivenFormat& g) { g.field = 4; }, "interlaced");
  GivenFormat roomy = good;
  roomy.image_bytes += 4096;
  EXPECT_TRUE(check_given(asked, roomy)) << "room behind the picture does no harm";
}

TEST(FormatNegotiation, names_are_readable) {
  EXPECT_EQ(fourcc_text(y12), "Y12");
  EXPECT_EQ(fourcc_text(y16_be), "Y16 (big-endian)");
  EXPECT_EQ(fourcc_text(grey), "GREY");
  EXPECT_EQ(fourcc_text(0x00FF0A41), "A\\x0a\\xff\\x00");
}

} // namespace
} // namespace octascope::hal::linux_backend
