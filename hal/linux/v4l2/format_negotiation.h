// Chooses among the formats that a driver offers the one for the wanted B-scans, and checks the
// format that the driver then gave. Pure; safe with any answers of a driver.
//
// A B-scan is an image of samples_per_line × lines_per_frame pixels.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/line_camera.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct SizeSpan {
  std::uint32_t least = 0, most = 0, step = 1; // least == most: a single size
  bool operator==(const SizeSpan&) const = default;
};

struct OfferedSize {
  SizeSpan width, height;
};

struct OfferedFormat {
  std::uint32_t code = 0;
  std::vector<OfferedSize> sizes; // empty: the driver lists none
};

struct FormatRequest {
  std::uint32_t code = 0;
  std::uint32_t width = 0, height = 0;
  std::uint32_t bytes_per_line = 0;
  bool operator==(const FormatRequest&) const = default;
};

// The driver's answer. `field` is the kernel's: 0 any, 1 progressive, others interlaced.
struct GivenFormat {
  std::uint32_t code = 0;
  std::uint32_t width = 0, height = 0;
  std::uint32_t bytes_per_line = 0, image_bytes = 0;
  std::uint32_t field = 0;
};

// ErrorCode::invalid_argument for what no camera can deliver: sizes that are not positive or exceed
// 2 GB, more bits than the sample holds.
Result<> check_request(const LineFormat& wanted);

// The formats to request from the driver, best first; never empty. ErrorCode::absent: nothing is
// offered (yet). ErrorCode::unsupported: nothing fits; the message has what is offered and what is
// expected. Sizes between a driver's steps are requested too: not all drivers insist on their
// steps.
Result<std::vector<FormatRequest>> rank_formats(std::span<const OfferedFormat> offered,
                                                const LineFormat& wanted);

// ErrorCode::unsupported, with found and expected, if the memory layout is not the one requested:
// another format or size, padded lines, interlaced lines, an image that is too small.
Result<> check_given(const FormatRequest& asked, const GivenFormat& given);

// "GREY 320×180 to 4096×2160, Y12 and 20 other formats": what is offered, for messages. Only
// formats that can be read are named, with their sizes.
std::string words(std::span<const OfferedFormat> offered);

// "379 lines of 1024 samples, 12 bits in u16, shift 0"
std::string words(const LineFormat& wanted);

} // namespace octascope::hal::linux_backend
