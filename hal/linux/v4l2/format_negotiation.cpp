#include "hal/linux/v4l2/format_negotiation.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "hal/linux/v4l2/pixel_formats.h"

namespace octascope::hal::linux_backend {

namespace {

constexpr std::size_t most_named = 8;       // formats in a message
constexpr std::size_t most_sizes_named = 3; // of one format
constexpr std::uint32_t field_any = 0;
constexpr std::uint32_t field_progressive = 1;

// How well a format holds the samples: 0 exactly, 1 with room to spare, below 0 not.
int fit(const LinePixelFormat& format, const LineFormat& wanted) {
  const int bits = wanted.significant_bits + wanted.right_shift;
  if (format.type != wanted.sample_type)
    return -1;
  const int all_of_type = format.type == SampleType::u8 ? 8 : 16;
  if (format.bits == all_of_type)
    return bits == all_of_type ? 0 : 1;
  // A format that names its bits says where full scale is.
  return wanted.right_shift == 0 && format.bits == bits ? 0 : -1;
}

bool within(const SizeSpan& span, std::uint32_t size) {
  return size >= span.least && size <= span.most;
}

bool may_have(const OfferedFormat& offered, std::uint32_t width, std::uint32_t height) {
  return offered.sizes.empty() || std::ranges::any_of(offered.sizes, [&](const OfferedSize& size) {
           return within(size.width, width) && within(size.height, height);
         });
}

std::string size_words(const OfferedSize& size) {
  if (size.width.least == size.width.most && size.height.least == size.height.most)
    return fmt::format("{}×{}", size.width.least, size.height.least);
  return fmt::format("{}×{} to {}×{}", size.width.least, size.height.least, size.width.most,
                     size.height.most);
}

std::string format_words(const OfferedFormat& offered) {
  std::string text = fourcc_text(offered.code);
  for (std::size_t i = 0; i < std::min(offered.sizes.size(), most_sizes_named); ++i)
    text += (i == 0 ? " " : " or ") + size_words(offered.sizes[i]);
  if (offered.sizes.size() > most_sizes_named)
    text += fmt::format(" and {} more sizes", offered.sizes.size() - most_sizes_named);
  return text;
}

// The names of the formats that would serve: "Y12 or Y16".
std::string serving(const LineFormat& wanted) {
  std::string text;
  for (const LinePixelFormat& format : line_pixel_formats()) {
    if (fit(format, wanted) >= 0)
      text += (text.empty() ? "" : " or ") + fourcc_text(format.code);
  }
  return text;
}

tl::unexpected<Error> nothing_fits(std::span<const OfferedFormat> offered,
                                   const LineFormat& wanted) {
  std::string reason;
  for (const OfferedFormat& format : offered) {
    const bool known_turned = line_pixel_format(format.code & ~big_endian_mark) != nullptr;
    if (line_pixel_format(format.code) == nullptr && (known_turned || offered.size() == 1))
      reason += fmt::format("; {} has {}", fourcc_text(format.code), why_unreadable(format.code));
  }
  return fail(ErrorCode::unsupported, "it offers {}{}; expected {} at {}×{} pixels ({})",
              words(offered), reason, serving(wanted), wanted.samples_per_line,
              wanted.lines_per_frame, words(wanted));
}

} // namespace

std::string words(std::span<const OfferedFormat> offered) {
  const auto readable = [](const OfferedFormat& format) {
    return line_pixel_format(format.code) != nullptr;
  };
  const bool some = std::ranges::any_of(offered, readable);
  std::string text;
  std::size_t named = 0;
  for (const OfferedFormat& format : offered) {
    if (named < most_named && (!some || readable(format)))
      text += (named++ == 0 ? "" : ", ") + format_words(format);
  }
  if (named < offered.size())
    text += fmt::format(" and {} other formats", offered.size() - named);
  return text;
}

std::string words(const LineFormat& wanted) {
  return fmt::format("{} lines of {} samples, {} bits in {}, shift {}", wanted.lines_per_frame,
                     wanted.samples_per_line, wanted.significant_bits,
                     to_string(wanted.sample_type), wanted.right_shift);
}

Result<> check_request(const LineFormat& wanted) {
  const auto refuse = [&](std::string_view expected) {
    return fail(ErrorCode::invalid_argument, "the format is {}; expected {}", words(wanted),
                expected);
  };
  if (wanted.samples_per_line < 1 || wanted.lines_per_frame < 1)
    return refuse("at least one line of one sample");
  if (wanted.sample_type == SampleType::f32)
    return refuse("samples that a camera has, u8 or u16");
  if (wanted.frame_bytes() > std::numeric_limits<std::int32_t>::max())
    return refuse("B-scans of less than 2 GB");
  const int most_bits = wanted.sample_type == SampleType::u8 ? 8 : 16;
  if (wanted.significant_bits < 1 || wanted.significant_bits > most_bits ||
      wanted.right_shift < 0 || wanted.right_shift > most_bits - wanted.significant_bits)
    return refuse(fmt::format("bits and shift to be at most {} together", most_bits));
  return {};
}

Result<std::vector<FormatRequest>> rank_formats(std::span<const OfferedFormat> offered,
                                                const LineFormat& wanted) {
  HAL_CHECK(check_request(wanted));
  if (offered.empty())
    return fail(ErrorCode::absent, "it offers no format yet: is what feeds it running, and is its "
                                   "cable plugged in? It is tried again by itself");
  const auto width = static_cast<std::uint32_t>(wanted.samples_per_line);
  const auto height = static_cast<std::uint32_t>(wanted.lines_per_frame);
  std::vector<FormatRequest> requests;
  for (const int wanted_fit : {0, 1}) {
    for (const OfferedFormat& format : offered) {
      const LinePixelFormat* known = line_pixel_format(format.code);
      if (known != nullptr && fit(*known, wanted) == wanted_fit && may_have(format, width, height))
        requests.push_back(
            {format.code, width, height, static_cast<std::uint32_t>(wanted.line_bytes())});
    }
  }
  if (requests.empty())
    return nothing_fits(offered, wanted);
  return requests;
}

Result<> check_given(const FormatRequest& asked, const GivenFormat& given) {
  const auto refuse = [](std::string found_and_expected) {
    return fail(ErrorCode::unsupported, "the driver gave " + std::move(found_and_expected));
  };
  if (given.code != asked.code)
    return refuse(fmt::format("{}, expected {}", fourcc_text(given.code), fourcc_text(asked.code)));
  if (given.width != asked.width || given.height != asked.height)
    return refuse(fmt::format("{}×{} pixels, expected {}×{}: set samples per line and lines per "
                              "B-scan to what the camera can do",
                              given.width, given.height, asked.width, asked.height));
  if (given.field != field_progressive && given.field != field_any)
    return refuse(
        fmt::format("interlaced lines (field {}), expected progressive ones", given.field));
  if (given.bytes_per_line != asked.bytes_per_line)
    return refuse(fmt::format("lines of {} bytes, expected {} without padding: choose a number of "
                              "samples per line that the driver does not pad",
                              given.bytes_per_line, asked.bytes_per_line));
  const std::uint64_t expected = std::uint64_t{asked.bytes_per_line} * asked.height;
  if (given.image_bytes < expected)
    return refuse(
        fmt::format("pictures of {} bytes, expected at least {}", given.image_bytes, expected));
  return {};
}

} // namespace octascope::hal::linux_backend
