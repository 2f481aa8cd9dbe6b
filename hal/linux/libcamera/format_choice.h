// Chooses which of a camera's formats to request. Pure: can be tested without a camera.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/scope_camera.h"

namespace octascope::hal::linux_backend {

// How the camera delivers pixels. All but motion_jpeg go to the display unchanged.
enum class Encoding : std::uint8_t { nv12, yuyv, rgb8, rgba8, motion_jpeg };

struct PictureSize {
  int width = 0;
  int height = 0;
  bool operator==(const PictureSize&) const = default;
};

// One pixel format that a camera offers. `fourcc` as in the kernel's drm_fourcc.h.
struct CameraFormat {
  std::uint32_t fourcc = 0;
  std::vector<PictureSize> sizes;
  // If the camera scales: any size between the two.
  struct Range {
    PictureSize smallest;
    PictureSize largest;
  };
  std::optional<Range> range;
};

struct FormatCandidate {
  std::uint32_t fourcc = 0;
  Encoding encoding = Encoding::nv12;
  PictureSize size;
};

// Empty for formats that the display cannot draw.
std::optional<Encoding> encoding_of(std::uint32_t fourcc);

// The formats that the display can draw, best first: nearest to the requested size, then with the
// fewest bytes. Motion JPEG costs processor time and sharpness, so it comes after the raw formats,
// except those that need more bandwidth than USB 2 has: cameras then silently deliver only a few
// frames per second.
std::vector<FormatCandidate> choose_formats(const std::vector<CameraFormat>& offered,
                                            const ScopeCameraConfig& config);

// The format of the frames that ScopeCamera delivers for this encoding.
PixelFormat pixel_format(Encoding encoding);

// The least number of bytes for a row of `width` pixels; 0 for motion_jpeg.
std::size_t row_bytes(Encoding encoding, int width);

// The number of rows of an image, including NV12's chroma rows.
std::size_t row_count(Encoding encoding, int height);

// For messages: "NV12", or "0x00000001" if it is not printable.
std::string format_name(std::uint32_t fourcc);

} // namespace octascope::hal::linux_backend
