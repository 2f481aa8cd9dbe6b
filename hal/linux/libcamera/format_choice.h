// Which of a camera's formats to ask for. Pure: no camera is needed to try it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/scope_camera.h"

namespace octascope::hal::linux_backend {

// What pixels come as. All but motion_jpeg go to the display as they are.
enum class Encoding : std::uint8_t { nv12, yuyv, rgb8, rgba8, motion_jpeg };

struct PictureSize {
  int width = 0;
  int height = 0;
  bool operator==(const PictureSize&) const = default;
};

// One pixel format that a camera offers. `fourcc` as in the kernel's drm_fourcc.h.
struct OfferedFormat {
  std::uint32_t fourcc = 0;
  std::vector<PictureSize> sizes;
  // Where the camera scales: any size between the two.
  struct Range {
    PictureSize smallest;
    PictureSize largest;
  };
  std::optional<Range> range;
};

struct FormatWish {
  std::uint32_t fourcc = 0;
  Encoding encoding = Encoding::nv12;
  PictureSize size;
};

// Empty for what the display cannot draw.
std::optional<Encoding> encoding_of(std::uint32_t fourcc);

// What the display draws, the best first: its size nearest to the wish, then the fewest bytes.
// Motion JPEG costs processor time and sharpness, so it comes last; unless raw pictures would be
// more than a USB 2 cable carries, at which cameras quietly fall to a few frames a second.
std::vector<FormatWish> choose_formats(const std::vector<OfferedFormat>& offered,
                                       const ScopeCameraConfig& config);

// What frames of this encoding are called at our interface.
PixelFormat pixel_format(Encoding encoding);

// The least that a row of so many pixels takes; 0 for motion_jpeg.
std::size_t row_bytes(Encoding encoding, int width);

// All rows of a picture: those of NV12's chroma included.
std::size_t row_count(Encoding encoding, int height);

// "NV12", for messages; "0x00000001" where it is no text.
std::string format_name(std::uint32_t fourcc);

} // namespace octascope::hal::linux_backend
