// Which of the formats that a driver offers brings B-scans as they are wanted, and whether what it
// then gave is that. Pure: numbers in, numbers or words out; whatever a driver says does no harm.
//
// A B-scan is a picture of samples_per_line × lines_per_frame pixels.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/line_camera.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct SizeSpan {
  std::uint32_t least = 0, most = 0, step = 1; // least == most: that one size
  bool operator==(const SizeSpan&) const = default;
};

struct OfferedSize {
  SizeSpan width, height;
};

struct OfferedFormat {
  std::uint32_t code = 0;
  std::vector<OfferedSize> sizes; // empty: the driver does not tell
};

struct FormatRequest {
  std::uint32_t code = 0;
  std::uint32_t width = 0, height = 0;
  std::uint32_t bytes_per_line = 0;
  bool operator==(const FormatRequest&) const = default;
};

// As the driver answers. Its fields are the kernel's: 0 any, 1 progressive, others interlaced.
struct GivenFormat {
  std::uint32_t code = 0;
  std::uint32_t width = 0, height = 0;
  std::uint32_t bytes_per_line = 0, image_bytes = 0;
  std::uint32_t field = 0;
};

// ErrorCode::invalid_argument for what no camera can bring: sizes that are not positive, or of more
// than 2 GB, more bits than the sample holds.
Result<> check_wish(const LineFormat& wanted);

// What to ask the driver for, best first; never empty. ErrorCode::absent: nothing is offered (yet).
// ErrorCode::unsupported: nothing fits, the message has what is offered and what is expected.
// Sizes between a driver's steps are asked for all the same: not every driver means its steps.
Result<std::vector<FormatRequest>> rank_formats(std::span<const OfferedFormat> offered,
                                                const LineFormat& wanted);

// ErrorCode::unsupported with found and expected where lines or samples would not lie where they
// are read: another format or size, padded lines, interlaced lines, too small a picture.
Result<> check_given(const FormatRequest& asked, const GivenFormat& given);

// "GREY 320×180 to 4096×2160, Y12 and 20 other formats": what is offered, for messages. Those that
// can be read come by name, with their sizes.
std::string words(std::span<const OfferedFormat> offered);

// "379 lines of 1024 samples, 12 bits in u16, shift 0"
std::string words(const LineFormat& wanted);

} // namespace octascope::hal::linux_backend
