#include "hal/linux/aravis/genicam_pixels.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace octascope::hal::linux_backend {

namespace {

constexpr std::array known{
    GenicamFormat{"Mono8", SampleType::u8, 8, Packing::none},
    GenicamFormat{"Mono10p", SampleType::u16, 10, Packing::mono10p},
    GenicamFormat{"Mono10Packed", SampleType::u16, 10, Packing::mono10_packed},
    GenicamFormat{"Mono10", SampleType::u16, 10, Packing::none},
    GenicamFormat{"Mono12p", SampleType::u16, 12, Packing::mono12p},
    GenicamFormat{"Mono12Packed", SampleType::u16, 12, Packing::mono12_packed},
    GenicamFormat{"Mono12", SampleType::u16, 12, Packing::none},
    GenicamFormat{"Mono14", SampleType::u16, 14, Packing::none},
    GenicamFormat{"Mono16", SampleType::u16, 16, Packing::none},
};

bool is_whole_type(const GenicamFormat& format) {
  return format.bits == (format.type == SampleType::u8 ? 8 : 16);
}

bool fits(const GenicamFormat& format, const LineFormat& wanted) {
  return format.type == wanted.sample_type &&
         (is_whole_type(format) ||
          (wanted.right_shift == 0 && format.bits == wanted.significant_bits));
}

// As they are sent, with Mono8 as the packing that it is in words of 16 bits.
std::vector<GenicamFormat> of_other_depths(const LineFormat& wanted) {
  std::vector<GenicamFormat> formats;
  for (GenicamFormat format : known) {
    if (format.bits == wanted.significant_bits || 2 * format.bits < wanted.significant_bits)
      continue;
    if (format.type == SampleType::u8)
      format.packing = Packing::mono8;
    format.type = SampleType::u16;
    formats.push_back(format);
  }
  std::ranges::stable_sort(formats, std::greater{}, &GenicamFormat::bits);
  return formats;
}

Result<> check_own_depth(std::span<const std::string> offered, const LineFormat& wanted) {
  const auto own = std::ranges::find_if(depths_bits, [&](int bits) {
    return choose_genicam_format(offered, with_depth(wanted, bits)).has_value();
  });
  if (own == depths_bits.end() || *own == wanted.significant_bits)
    return {};
  return fail(ErrorCode::unsupported,
              "the camera offers {}, so that its own depth is {} bits, expected {}; set [devices] "
              "significant_bits, or start octascope with the camera on",
              fmt::join(offered, ", "), *own, wanted.significant_bits);
}

Result<> refuse(std::string why) {
  return fail(ErrorCode::invalid_argument, "line camera: " + std::move(why));
}

} // namespace

Result<> check_genicam_request(const LineCameraConfig& config) {
  const LineFormat& format = config.format;
  if (format.samples_per_line < 1 || format.lines_per_frame < 1)
    return refuse(fmt::format("{} lines of {} samples, expected at least one of each",
                              format.lines_per_frame, format.samples_per_line));
  const auto pixels = static_cast<std::int64_t>(format.samples_per_line) * format.lines_per_frame;
  if (pixels > std::numeric_limits<std::int32_t>::max() / 2)
    return refuse(fmt::format("a frame of {} samples, expected less than 2 GB", pixels));
  const int most = format.sample_type == SampleType::u8 ? 8 : 16;
  if (format.sample_type == SampleType::f32 || format.significant_bits < 1 ||
      format.right_shift < 0 || format.significant_bits + format.right_shift > most)
    return refuse(fmt::format("{} bits shifted by {} in {}, expected at most {} together",
                              format.significant_bits, format.right_shift,
                              to_string(format.sample_type), most));
  if (!(config.line_rate_hz >= 1 && config.line_rate_hz <= 1e9))
    return refuse(fmt::format("line_rate_hz is {}, expected 1 to 1e9", config.line_rate_hz));
  if (config.buffers < 1 || config.buffers > 4096)
    return refuse(fmt::format("buffers is {}, expected 1 to 4096", config.buffers));
  return {};
}

LineFormat with_depth(LineFormat format, int bits) {
  format.significant_bits = bits;
  format.sample_type = bits <= 8 ? SampleType::u8 : SampleType::u16;
  return format;
}

std::vector<GenicamFormat> genicam_formats_for(const LineFormat& wanted, Depths depths) {
  const bool others =
      depths == Depths::any && wanted.sample_type == SampleType::u16 && wanted.right_shift == 0;
  std::vector<GenicamFormat> formats;
  for (GenicamFormat format : known)
    if (fits(format, wanted) && (!others || format.bits == wanted.significant_bits)) {
      format.bits = wanted.significant_bits;
      formats.push_back(format);
    }
  if (others)
    std::ranges::copy(of_other_depths(wanted), std::back_inserter(formats));
  std::erase_if(formats, [&](const GenicamFormat& format) {
    return format.packing != Packing::none && wanted.samples_per_line % packed_group != 0;
  });
  return formats;
}

Result<GenicamFormat> choose_genicam_format(std::span<const std::string> offered,
                                            const LineFormat& wanted, Depths depths) {
  if (depths == Depths::own) {
    HAL_CHECK(check_own_depth(offered, wanted));
  }
  const auto serving = genicam_formats_for(wanted, depths);
  std::vector<std::string_view> names;
  for (const GenicamFormat& format : serving) {
    if (std::ranges::find(offered, format.name) != offered.end())
      return format;
    names.push_back(format.name);
  }
  return fail(ErrorCode::unsupported,
              "the camera offers {}, expected {} for {} bits; set [devices] significant_bits to "
              "what it has",
              fmt::join(offered, ", "), fmt::join(names, " or "), wanted.significant_bits);
}

} // namespace octascope::hal::linux_backend
