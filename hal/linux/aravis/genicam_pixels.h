// Which of GenICam's pixel formats deliver a line camera's spectra. Names: the EMVA's Pixel Format
// Naming Convention, 2.x. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/line_camera.h"
#include "hal/linux/aravis/packed_samples.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// ErrorCode::invalid_argument for what no camera can deliver.
Result<> check_genicam_request(const LineCameraConfig& config);

struct GenicamFormat {
  std::string_view name;
  SampleType type;
  int bits; // of a sample, right-justified
  Packing packing;
};

// Which formats serve.
enum class Depths : std::uint8_t {
  wanted, // of so many bits, or the whole type, in which a camera may use fewer
  own,    // likewise, where that is the camera's own depth: its counts are taken as they are
  any,    // of so many bits, or of others that are brought to them (packed_samples.h)
};

// Of a camera that offers several depths, the deepest is its own.
inline constexpr std::array depths_bits{16, 14, 12, 10, 8};

// `format` with so many bits, in the type that they need.
LineFormat with_depth(LineFormat format, int bits);

// Those that give this memory layout, best first: packed ones, as the wire is what limits a camera's
// line rate, then those that say their bits, then the whole type; of other depths the deepest first.
std::vector<GenicamFormat> genicam_formats_for(const LineFormat& wanted,
                                               Depths depths = Depths::wanted);

// The first of those that the camera offers. ErrorCode::unsupported, with found and expected: none.
Result<GenicamFormat> choose_genicam_format(std::span<const std::string> offered,
                                            const LineFormat& wanted,
                                            Depths depths = Depths::wanted);

} // namespace octascope::hal::linux_backend
