#include "hal/linux/libcamera/format_choice.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>

#include <fmt/format.h>

namespace octascope::hal::linux_backend {

namespace {

constexpr std::uint32_t code(char a, char b, char c, char d) {
  return static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b) << 8 |
         static_cast<std::uint32_t>(c) << 16 | static_cast<std::uint32_t>(d) << 24;
}

struct Known {
  std::uint32_t fourcc;
  Encoding encoding;
};

// The kernel names packed RGB after its little-endian word: BGR888 is red first in memory.
constexpr std::array<Known, 6> known_formats{{
    {code('N', 'V', '1', '2'), Encoding::nv12},
    {code('Y', 'U', 'Y', 'V'), Encoding::yuyv},
    {code('B', 'G', '2', '4'), Encoding::rgb8},
    {code('X', 'B', '2', '4'), Encoding::rgba8},
    {code('A', 'B', '2', '4'), Encoding::rgba8},
    {code('M', 'J', 'P', 'G'), Encoding::motion_jpeg},
}};

// What a USB 2 cable carries of pictures, with all that is lost on the way.
constexpr double usb2_bytes_per_s = 35e6;

int distance(PictureSize a, PictureSize b) {
  return std::abs(a.width - b.width) + std::abs(a.height - b.height);
}

std::optional<PictureSize> nearest(const CameraFormat& offer, PictureSize wanted) {
  if (offer.range)
    return PictureSize{
        std::clamp(wanted.width, offer.range->smallest.width, offer.range->largest.width),
        std::clamp(wanted.height, offer.range->smallest.height, offer.range->largest.height)};
  const auto best = std::ranges::min_element(offer.sizes, [&](PictureSize a, PictureSize b) {
    return distance(a, wanted) < distance(b, wanted);
  });
  if (best == offer.sizes.end())
    return std::nullopt;
  return *best;
}

int rank(const FormatCandidate& candidate, double frames_per_s) {
  const double bytes_per_s =
      static_cast<double>(row_bytes(candidate.encoding, candidate.size.width) *
                          row_count(candidate.encoding, candidate.size.height)) *
      frames_per_s;
  const int order = static_cast<int>(candidate.encoding);
  constexpr int after_motion_jpeg = static_cast<int>(Encoding::motion_jpeg) + 1;
  return bytes_per_s > usb2_bytes_per_s ? after_motion_jpeg + order : order;
}

bool valid(CameraFormat::Range range) {
  return range.smallest.width > 0 && range.smallest.height > 0 &&
         range.smallest.width <= range.largest.width &&
         range.smallest.height <= range.largest.height;
}

} // namespace

std::optional<Encoding> encoding_of(std::uint32_t fourcc) {
  for (const Known& known : known_formats)
    if (known.fourcc == fourcc)
      return known.encoding;
  return std::nullopt;
}

std::vector<FormatCandidate> choose_formats(const std::vector<CameraFormat>& offered,
                                            const ScopeCameraConfig& config) {
  const PictureSize wanted{config.width, config.height};
  std::vector<FormatCandidate> candidates;
  for (const CameraFormat& offer : offered) {
    const auto encoding = encoding_of(offer.fourcc);
    if (!encoding || (offer.range && !valid(*offer.range)))
      continue;
    if (const auto size = nearest(offer, wanted); size && size->width > 0 && size->height > 0)
      candidates.push_back({offer.fourcc, *encoding, *size});
  }
  std::ranges::stable_sort(candidates, [&](const FormatCandidate& a, const FormatCandidate& b) {
    const int from_a = distance(a.size, wanted);
    const int from_b = distance(b.size, wanted);
    return from_a != from_b ? from_a < from_b
                            : rank(a, config.frames_per_s) < rank(b, config.frames_per_s);
  });
  return candidates;
}

PixelFormat pixel_format(Encoding encoding) {
  switch (encoding) {
  case Encoding::nv12: return PixelFormat::nv12;
  case Encoding::yuyv: return PixelFormat::yuyv;
  case Encoding::rgba8: return PixelFormat::rgba8;
  case Encoding::rgb8:
  case Encoding::motion_jpeg: break;
  }
  return PixelFormat::rgb8;
}

std::size_t row_bytes(Encoding encoding, int width) {
  const auto pixels = static_cast<std::size_t>(width);
  switch (encoding) {
  case Encoding::nv12: return 2 * ((pixels + 1) / 2);
  case Encoding::yuyv: return 4 * ((pixels + 1) / 2);
  case Encoding::rgb8: return 3 * pixels;
  case Encoding::rgba8: return 4 * pixels;
  case Encoding::motion_jpeg: break;
  }
  return 0;
}

std::size_t row_count(Encoding encoding, int height) {
  const auto rows = static_cast<std::size_t>(height);
  return encoding == Encoding::nv12 ? rows + (rows + 1) / 2 : rows;
}

std::string format_name(std::uint32_t fourcc) {
  std::string text;
  for (int i = 0; i < 4; ++i)
    text.push_back(static_cast<char>(fourcc >> (8 * i) & 0xFF));
  const bool readable = std::ranges::all_of(
      text, [](char c) { return std::isprint(static_cast<unsigned char>(c)) != 0; });
  return readable ? text : fmt::format("{:#010x}", fourcc);
}

} // namespace octascope::hal::linux_backend
